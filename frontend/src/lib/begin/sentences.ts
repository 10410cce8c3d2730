/** What was said on the page, as sentences. */
import type { Text } from '#lib/text/text.svelte.ts';
import type { DeviceSketch, NeverSketch, Sketch, StepSketch } from './sketch.ts';
import type { Step } from './steps.ts';
import { factText, operationOf, thingsOf, titled, type Thing } from './things.ts';

export interface Sentence {
	readonly step: Step;
	readonly text: string;
}

/** Names in a sentence, all of them. */
function all(names: readonly string[], { locale }: Pick<Text, 'locale'>): string {
	return new Intl.ListFormat(locale, { type: 'conjunction' }).format(names);
}

/** `Never Robot in the pose “at the bolt” while Operator is busy`, without a full stop. */
export function neverText({ facts, during }: Pick<NeverSketch, 'facts' | 'during'>, things: readonly Thing[], text: Text): string {
	const words = text.begin;
	const never = facts.map((fact) => factText(fact, things, words, false));
	const meanwhile = during.map((fact) => factText(fact, things, words, true));
	return words.sentence.never(all(never, text), meanwhile.length > 0 ? all(meanwhile, text) : null);
}

/** The same as a sentence; one with a gap at its end has no full stop. */
export function neverSentence(never: Pick<NeverSketch, 'facts' | 'during'>, things: readonly Thing[], text: Text): string {
	const said = neverText(never, things, text);
	return said.endsWith(text.begin.blank) ? said : `${said}.`;
}

function deviceText(device: DeviceSketch, text: Text): string {
	const words = text.begin.sentence;
	const title = titled(device);
	if (device.kind === 'robot') return words.robot(title, all(device.poses.map(titled), text), device.ways === 'row' && device.poses.length > 2);
	return device.kind === 'found' ? words.found(title, device.topics.length) : words[device.kind](title);
}

function stepText(step: StepSketch, at: number, sketch: Sketch, text: Text): string {
	const words = text.begin.sentence;
	const by = sketch.devices.find(({ id }) => id === step.by);
	const where = step.where.flatMap(({ robot, pose }) => {
		const found = sketch.devices.find(({ id }) => id === robot);
		const there = found?.poses.find(({ id }) => id === pose);
		return found && there ? [words.stands(titled(found), titled(there))] : [];
	});
	const state = (number: number): string => titled(sketch.product.states[number] ?? { title: '', name: '' });
	const done = words.step(titled(step), by ? titled(by) : text.begin.blank, state(at), state(at + 1), by?.kind === 'clamp' && step.action ? words.how[step.action] : '');
	return where.length > 0 ? words.meanwhile(done, all(where, text)) : done;
}

/** Everything, in the order of the steps. */
export function sentences(sketch: Sketch, text: Text): Sentence[] {
	const words = text.begin.sentence;
	const { title, devices, product, never } = sketch;
	const found: Sentence[] = [];
	if (title.trim() !== '') found.push({ step: 'station', text: words.station(title.trim()) });
	for (const device of devices) found.push({ step: 'devices', text: device.kind === 'robot' ? words.arm(titled(device)) : deviceText(device, text) });
	for (const device of devices) if (device.kind === 'robot') found.push({ step: 'poses', text: deviceText(device, text) });
	const [first] = product.states;
	if (first) found.push({ step: 'product', text: words.first(titled(product), titled(first)) });
	found.push(...product.steps.map((step, at): Sentence => ({ step: 'product', text: stepText(step, at, sketch, text) })));
	for (const step of product.steps) {
		const operation = operationOf(step, sketch);
		if (operation !== step.name) found.push({ step: 'product', text: text.begin.product.calledBy(step.name, operation) });
	}
	if (product.states.length > 1) found.push({ step: 'product', text: words.then[product.then](titled(product)) });
	const things = thingsOf(sketch, text.begin.values);
	found.push(...never.map((each): Sentence => ({ step: 'never', text: neverSentence(each, things, text) })));
	return found;
}
