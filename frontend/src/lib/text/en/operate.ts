/** Operate. */
export const operate = {};
