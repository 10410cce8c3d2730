/** Restart. */
export const restart = {};
