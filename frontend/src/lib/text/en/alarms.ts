/** Alarms. */
export const alarms = {};
