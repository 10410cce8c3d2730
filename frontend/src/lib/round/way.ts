/** The end of an address of Operate that begins the round. */
export const ROUND = '#round';
