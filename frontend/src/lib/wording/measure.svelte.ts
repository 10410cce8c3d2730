/** How wide texts of drawings are, as of the picture and the plan, so that none reaches out of its card. */

/** The sizes of text in drawings. */
export type Font = 'strong' | 'second' | 'small';

const FONTS: Readonly<Record<Font, readonly [weight: number, size: number]>> = {
	strong: [620, 11.5],
	second: [560, 10.75],
	small: [520, 10]
};
/** How high their letters are, in units of the drawing. */
export const SIZE: Readonly<Record<Font, number>> = { strong: FONTS.strong[1], second: FONTS.second[1], small: FONTS.small[1] };
/** Of the size of a font, for where nothing can be measured. */
const LETTER = 0.58;

let context: OffscreenCanvasRenderingContext2D | null = null;
let family = '';
let known = new Map<string, number>();
/** Counts what the browser has loaded of fonts: with another font each text is of another width. */
let loaded = $state(0);

function canvas(): OffscreenCanvasRenderingContext2D | null {
	if (context !== null || typeof OffscreenCanvas === 'undefined') return context;
	context = new OffscreenCanvas(1, 1).getContext('2d');
	family = getComputedStyle(document.documentElement).getPropertyValue('--sans') || 'sans-serif';
	document.fonts.addEventListener('loadingdone', () => {
		known = new Map();
		loaded += 1;
	});
	return context;
}

/** The width of a text in units of the drawing. */
export function widthOf(text: string, font: Font): number {
	void loaded;
	const [weight, size] = FONTS[font];
	const measured = canvas();
	if (measured === null) return text.length * size * LETTER;
	const key = `${font} ${text}`;
	let width = known.get(key);
	if (width === undefined) {
		measured.font = `${weight} ${size}px ${family}`;
		width = measured.measureText(text).width;
		if (known.size > 2000) known = new Map();
		known.set(key, width);
	}
	return width;
}

/** Letters at the end of a long name that tell it from others, and the room, in units, from which on there is some for both its ends. */
const [END, LONG] = [7, 30];
const BOTH = 80;

/** As much of a text as there is room for; that something is left out is told by an ellipsis. Of a long one its end is kept, too. */
export function fit(text: string, room: number, font: Font, width: (text: string, font: Font) => number = widthOf): string {
	if (width(text, font) <= room) return text;
	const end = text.length > LONG && room >= BOTH ? text.slice(-END).trimStart() : '';
	let [most, none] = [0, text.length];
	while (none - most > 1) {
		const half = (most + none) >> 1;
		if (width(`${text.slice(0, half)}…${end}`, font) <= room) most = half;
		else none = half;
	}
	return most === 0 ? '…' : `${text.slice(0, most).trimEnd()}…${end}`;
}

/** A text in no more lines than `most`, broken between words; what the last one has no room for is left out as `fit` does. */
export function folded(text: string, room: number, font: Font, most: number, width: (text: string, font: Font) => number = widthOf): string[] {
	const words = text.split(' ');
	const lines: string[] = [];
	while (words.length > 0) {
		let line = words.shift() ?? '';
		const last = lines.length === most - 1;
		while (words.length > 0 && (last || width(`${line} ${words[0] ?? ''}`, font) <= room)) line += ` ${words.shift() ?? ''}`;
		lines.push(fit(line, room, font, width));
	}
	return lines;
}
