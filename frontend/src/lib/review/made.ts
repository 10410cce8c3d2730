/** What a draft makes that is the first of its station, in words: nobody has made so many changes. */
import type { FileMark } from '#lib/contract.ts';

export interface Made {
	readonly devices: number;
	readonly operations: boolean;
	readonly never: boolean;
	readonly order: boolean;
	readonly tests: number;
	readonly messages: number;
	/** Files beside those. */
	readonly others: number;
}

/** Null where the station has devices already: then changes are counted. */
export function madeIn(files: Readonly<Record<string, FileMark>>): Made | null {
	const all = Object.entries(files);
	const isDevice = (path: string): boolean => path.startsWith('resources/');
	const isNew = ({ state }: FileMark): boolean => state === 'new';
	if (!all.some(([path, mark]) => isDevice(path) && isNew(mark)) || all.some(([path, mark]) => isDevice(path) && !isNew(mark))) return null;
	const made = all.filter(([, mark]) => isNew(mark)).map(([path]) => path);
	const [devices, tests, messages] = [isDevice, (path: string): boolean => path.startsWith('tests/'), (path: string): boolean => /\.(?:msg|srv|action)$/.test(path)].map((of) => made.filter(of).length);
	const [operations, never, order] = ['operations.yaml', 'specifications.yaml', 'work_masters.yaml'].map((file) => made.includes(file));
	const known = { devices: devices ?? 0, operations: operations === true, never: never === true, order: order === true, tests: tests ?? 0, messages: messages ?? 0 };
	const counted = known.devices + known.tests + known.messages + [operations, never, order].filter(Boolean).length;
	return { ...known, others: made.length - counted };
}
