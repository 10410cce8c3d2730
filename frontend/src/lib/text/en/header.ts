/** The header. */
export const header = {};
