/** The same examples in every run: a change that breaks a law is told by the run that has it. `EXAMPLES=5000` tries others too. */
import { configureGlobal } from 'fast-check';

const examples = Number(process.env['EXAMPLES']);
configureGlobal(examples > 0 ? { numRuns: examples } : { seed: 20_260_101 });
