/** Signing in, and administration. */
export const account = {};
