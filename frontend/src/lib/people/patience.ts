/** Milliseconds to wait for an answer before which a password is hashed: on a small machine, behind others. */
export const HASHING = 20_000;
