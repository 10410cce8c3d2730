/** State, and corrections of it. */
export const state = {};
