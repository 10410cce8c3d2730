/** The watch. */
export const watch = {};
