import { count } from '../count.ts';

/** Tänk om: simulering av modellens utkast. */
export const whatIf = {
	title: 'Tänk om',
	simulated: 'Simulerat. Stationen berörs inte.',
	role: 'Bara ingenjörer simulerar. Fråga en av dem.',
	from: 'Var det börjar',
	present: 'Stationen som den är nu',
	past: 'En post i dess historik',
	record: 'Postens nummer',
	seconds: 'I hur många sekunder',
	go: 'Simulera',
	going: 'Simulerar …',
	stop: 'Avbryt',
	working: (passed: number, most: number): string =>
		`Det har arbetat i ${count(passed, 'sekund', 'sekunder')}. Först förbereds modellen; vad som sedan har simulerats inom ${most} s visas.`,
	result: 'Vad som skulle hända',
	obstacle: (why: string): string => `Inget kunde simuleras: ${why}`,
	done: (seconds: number, runs: number, operations: number): string =>
		`${count(Math.round(seconds), 'sekund', 'sekunder')} simulerade: ${count(runs, 'körning', 'körningar')} av förmågor, ${count(operations, 'operation slutförd', 'operationer slutförda')}.`,
	unsafe: 'Det börjar utanför modellens säkra tillstånd, så operationer startar inget.',
	unplanned: (why: string): string => `Till slut: ${why}.`,
	operations: 'Operationer',
	runs: 'Körningar av förmågor',
	ability: 'Förmåga',
	started: 'Startar efter',
	ended: 'Slutar efter',
	goesOn: 'pågår',
	nothing: 'Inget startas',
	completed: 'Slutförda operationer',
	changes: 'Annorlunda till slut'
};
