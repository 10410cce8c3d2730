/** How much room the header has. */
import { MediaQuery } from 'svelte/reactivity';

/** There is too little for all of the header to stay in sight; the styles have the same limits. */
export const short = new MediaQuery('(max-height: 40rem) or (max-width: 75rem)');
