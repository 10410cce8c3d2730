/** Parts that are moved and taken away, with what goes along; what was said of them elsewhere stays to be put right. */
import type { Sketch } from './sketch.ts';

/** Puts the part at `index` in the place of the one beside it. */
export function move<T>(parts: T[], index: number, by: -1 | 1): void {
	const [part, other] = [parts[index], parts[index + by]];
	if (part === undefined || other === undefined) return;
	parts[index] = other;
	parts[index + by] = part;
}

export function remove(parts: { readonly id: number }[], id: number): void {
	const at = parts.findIndex((each) => each.id === id);
	if (at >= 0) parts.splice(at, 1);
}

/** Takes a device away. Where it does something, or stands, that is to be put right. */
export function removeDevice(sketch: Sketch, id: number): void {
	remove(sketch.devices, id);
}

/** Takes a state away, and the step that leads to it; with the first state the one that leads on. */
export function removeState({ product }: Pick<Sketch, 'product'>, id: number): void {
	const at = product.states.findIndex((each) => each.id === id);
	if (at < 0) return;
	product.states.splice(at, 1);
	product.steps.splice(Math.max(0, at - 1), 1);
}
