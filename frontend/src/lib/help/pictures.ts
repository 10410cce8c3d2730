/** Each page as a few strokes, and where in it the lines of its help are about: the first number is the first line's. */
import type { HelpedPage } from './helped.ts';

type Box = 'card' | 'soft' | 'well' | 'act' | 'past';
type Stroke = 'line' | 'now' | 'high' | 'medium';

/** In the units of the picture, which is 240 wide and 112 high; the rail is 26 wide and the bar 11 high. */
export type Shape =
	| { [Kind in Box]: readonly [Kind, x: number, y: number, width: number, height: number] }[Box]
	| { [Kind in Stroke]: readonly [Kind, path: string] }[Stroke]
	| readonly ['words', x: number, y: number, width: number]
	| readonly ['ring', x: number, y: number, radius: number];

export interface Picture {
	readonly shapes: readonly Shape[];
	readonly places: readonly (readonly [x: number, y: number])[];
	/** It has neither bar nor rail. */
	readonly bare?: boolean;
}

/** Lines of words, one below the other. */
function lines(x: number, y: number, widths: readonly number[], step = 8): Shape[] {
	return widths.map((width, n) => ['words', x, y + n * step, width]);
}

/** What leads to what, as rows of which one is chosen. */
function list(x: number, y: number, width: number, height: number, chosen = 0): Shape[] {
	const rows = Math.floor((height - 4) / 12);
	return [
		['card', x, y, width, height],
		['soft', x + 2, y + 2 + chosen * 12, width - 4, 11],
		...Array.from({ length: rows }, (_, n): Shape => ['words', x + 7, y + 8 + n * 12, width * (n % 2 === 0 ? 0.6 : 0.45)])
	];
}

/** A table below a line of what narrows it. */
function table(y: number, rows: number): Shape[] {
	return [
		['card', 32, y, 202, 108 - y],
		...Array.from({ length: rows }, (_, n) => y + 8 + n * 12).flatMap((at): Shape[] => [
			['words', 39, at, 44],
			['words', 100, at, 30],
			['words', 152, at, 22],
			['words', 196, at, 26]
		])
	];
}

/** Bars in time, on three lanes from `y` on, with what is now. */
function lanes(x: number, y: number, width: number): Shape[] {
	return [
		['well', x, y, width, 30],
		['past', x + 3, y + 3, width * 0.24, 6],
		['past', x + width * 0.16, y + 12, width * 0.2, 6],
		['soft', x + width * 0.32, y + 3, width * 0.24, 6],
		['card', x + width * 0.58, y + 12, width * 0.18, 6],
		['card', x + width * 0.7, y + 21, width * 0.24, 6],
		['now', `M${x + width * 0.45} ${y - 2}v34`]
	];
}

/** A robot's way over a product with places. */
function station(x: number, y: number, width: number, height: number): Shape[] {
	const middle = y + height * 0.3;
	return [
		['well', x, y, width, height],
		['line', `M${x + 8} ${middle}h${width - 16}M${x + width / 2} ${middle}v${height * 0.22}`],
		['ring', x + 8, middle, 2],
		['ring', x + width - 8, middle, 2],
		['soft', x + width * 0.28, middle - 4, 8, 8],
		['card', x + width * 0.34, y + height * 0.55, width * 0.32, height * 0.35],
		['ring', x + width * 0.43, y + height * 0.72, 2.5],
		['ring', x + width * 0.5, y + height * 0.72, 2.5],
		['ring', x + width * 0.57, y + height * 0.72, 2.5]
	];
}

const OCTAGON: Shape = ['high', 'M38 26l3-3h4l3 3v4l-3 3h-4l-3-3z'];

/** An alarm of medium priority, or a warning. */
const triangle = (x: number, y: number): Shape => ['medium', `M${x} ${y - 4}l5.5 9h-11z`];

/** What is made and kept, as a form and as a list of what there is. */
const kept = (places: Picture['places']): Picture => ({
	shapes: [['card', 32, 18, 202, 32], ...lines(39, 27, [60, 90, 40]), ['act', 196, 36, 30, 9], ...table(56, 4)],
	places
});

export const PICTURES: Readonly<Record<HelpedPage, Picture>> = {
	operate: {
		shapes: [
			['card', 31, 16, 136, 50],
			...station(34, 19, 130, 44),
			['card', 31, 70, 136, 38],
			...lanes(34, 74, 130),
			['soft', 171, 16, 64, 34],
			...lines(177, 24, [36, 46]),
			['act', 177, 38, 26, 8],
			['card', 171, 54, 64, 54],
			...lines(185, 63, [34, 42, 28, 40], 12),
			...[63, 75, 87, 99].map((y): Shape => ['ring', 178, y, 2.5]),
			['card', 192, 2.5, 18, 6.5],
			['card', 213, 2.5, 18, 6.5]
		],
		places: [
			[42, 27],
			[42, 96],
			[226, 26],
			[226, 66],
			[182, 8]
		]
	},
	restart: {
		shapes: [
			...[0, 1, 2, 3].map((n): Shape => [n === 1 ? 'soft' : 'card', 32 + n * 51, 18, 49, 17]),
			...[0, 1, 2, 3].map((n): Shape => ['words', 50 + n * 51, 27, 22]),
			['card', 32, 40, 202, 66],
			...lines(40, 50, [90, 120, 70]),
			['act', 40, 74, 44, 9],
			['card', 90, 74, 34, 9]
		],
		places: [
			[40, 27],
			[91, 27],
			[142, 27],
			[193, 27]
		]
	},
	state: {
		shapes: [['card', 40, 16, 60, 9], ['card', 104, 16, 26, 9], ...table(30, 6), ['soft', 34, 44, 198, 11], ['words', 39, 50, 44], ['words', 100, 50, 30], ['act', 196, 46, 24, 7]],
		places: [
			[38, 20],
			[90, 50],
			[226, 50],
			[37, 74]
		]
	},
	alarms: {
		shapes: [
			...list(32, 18, 78, 90),
			OCTAGON,
			triangle(43, 40),
			['card', 114, 18, 120, 90],
			...lines(122, 30, [70, 96, 84, 60], 10),
			['act', 122, 74, 40, 9],
			['card', 168, 74, 32, 9],
			['words', 34, 14, 14],
			['words', 54, 14, 14]
		],
		places: [
			[104, 25],
			[226, 30],
			[142, 90],
			[184, 90],
			[76, 15]
		]
	},
	history: {
		shapes: [
			['card', 32, 16, 202, 40],
			...lanes(38, 22, 190),
			['card', 32, 60, 62, 48],
			...station(35, 63, 56, 42),
			['card', 98, 60, 72, 48],
			...lines(105, 70, [50, 40, 54, 36]),
			['card', 174, 60, 60, 48],
			...lines(181, 70, [40, 34, 44, 30])
		],
		places: [
			[124, 40],
			[216, 18],
			[40, 68],
			[104, 68],
			[180, 68],
			[232, 60]
		]
	},
	orders: {
		shapes: [
			...[0, 1, 2, 3].map((n): Shape => ['well', 32 + n * 51, 28, 49, 80]),
			...[0, 1, 2].map((n): Shape => ['card', 86, 40 + n * 21, 43, 18]),
			['soft', 137, 40, 43, 18],
			['card', 35, 40, 43, 18],
			['card', 188, 40, 43, 18],
			...lines(91, 48, [26, 20, 30], 21),
			...lines(142, 48, [26]),
			...lines(40, 48, [20]),
			...lines(193, 48, [24]),
			['card', 150, 15, 34, 9],
			['act', 192, 15, 40, 9]
		],
		places: [
			[40, 34],
			[126, 43],
			[74, 58],
			[226, 19],
			[150, 19]
		]
	},
	wall: {
		shapes: [
			['soft', 6, 6, 60, 16],
			['words', 78, 14, 60],
			['words', 190, 14, 40],
			...station(6, 28, 140, 56),
			['card', 152, 28, 82, 26],
			['card', 152, 58, 82, 26],
			['card', 6, 90, 228, 16],
			['words', 16, 98, 120]
		],
		places: [
			[70, 14],
			[14, 34],
			[228, 98],
			[232, 14]
		],
		bare: true
	},
	model: {
		shapes: [...list(32, 18, 56, 90, 2), ['card', 92, 18, 142, 66], ...lines(100, 28, [30, 100, 40, 90, 60, 80], 9), ['card', 92, 88, 142, 20], triangle(100, 95), ['words', 110, 98, 80], ['card', 206, 14, 22, 8]],
		places: [
			[82, 48],
			[226, 50],
			[226, 98],
			[202, 17]
		]
	},
	operations: {
		shapes: [
			['card', 32, 22, 146, 86],
			['line', 'M32 50h146M32 79h146'],
			['past', 40, 30, 30, 13],
			['soft', 82, 58, 30, 13],
			['card', 124, 58, 30, 13],
			['card', 130, 87, 30, 13],
			['now', 'M70 36c8 0 4 28 12 28M112 64h12'],
			['line', 'M112 64c10 0 8 29 18 29'],
			['card', 184, 22, 50, 86],
			...lines(190, 32, [34, 26, 38, 30, 22], 12),
			['words', 176, 16, 24],
			['words', 206, 16, 20]
		],
		places: [
			[72, 22],
			[180, 30],
			[112, 74],
			[170, 12]
		]
	},
	pipelines: {
		shapes: [
			...list(32, 18, 50, 90, 1),
			['well', 86, 18, 148, 62],
			['card', 92, 40, 34, 16],
			['soft', 142, 40, 34, 16],
			['card', 192, 40, 34, 16],
			['line', 'M126 48h16M176 48h16'],
			['card', 86, 84, 148, 24],
			['words', 94, 92, 70],
			['act', 196, 92, 28, 9]
		],
		places: [
			[76, 37],
			[159, 48],
			[188, 96]
		]
	},
	ros: {
		shapes: [['card', 32, 18, 202, 18], OCTAGON, ['words', 54, 28, 110], ...table(46, 5), ['soft', 34, 60, 198, 11], ['words', 39, 66, 44], ['card', 160, 39, 60, 7]],
		places: [
			[226, 27],
			[94, 66],
			[226, 43]
		]
	},
	whatIf: {
		shapes: [['card', 32, 18, 202, 28], ['card', 40, 27, 50, 10], ['card', 98, 27, 40, 10], ['act', 146, 27, 40, 10], ['card', 32, 52, 202, 54], ...lanes(40, 58, 186), ...lines(40, 97, [80])],
		places: [
			[44, 24],
			[188, 24],
			[216, 60]
		]
	},
	begin: {
		shapes: [
			['card', 32, 18, 202, 90],
			['line', 'M74 18v90M166 18v90'],
			['soft', 35, 34, 36, 11],
			...lines(42, 28, [22, 26, 18, 24, 20], 12),
			...lines(82, 28, [50], 9),
			['card', 82, 36, 76, 12],
			['card', 82, 54, 34, 12],
			['card', 124, 54, 34, 12],
			['act', 132, 92, 28, 10],
			...lines(174, 28, [40, 30, 48, 36, 44, 24, 40], 10)
		],
		places: [
			[64, 96],
			[150, 30],
			[226, 100],
			[122, 97]
		]
	},
	review: {
		shapes: [
			['words', 34, 19, 110],
			['card', 32, 26, 132, 40],
			...lines(40, 34, [90, 100, 70], 12),
			['card', 32, 70, 132, 38],
			['past', 44, 78, 40, 6],
			['soft', 44, 88, 58, 6],
			['card', 168, 16, 66, 24],
			...lines(176, 24, [40, 34]),
			['card', 168, 44, 66, 36],
			...lines(176, 52, [36, 40]),
			['act', 173, 66, 56, 10],
			['card', 168, 84, 66, 24],
			...lines(176, 92, [30, 38])
		],
		places: [
			[156, 34],
			[156, 78],
			[228, 22],
			[228, 52],
			[228, 92]
		]
	},
	journal: {
		shapes: [['card', 40, 16, 50, 9], ['card', 96, 16, 50, 9], ...table(30, 6), ['soft', 34, 44, 198, 11], ['words', 39, 50, 44], ['words', 100, 50, 30]],
		places: [
			[90, 36],
			[150, 20],
			[226, 50]
		]
	},
	watches: {
		shapes: [
			['card', 32, 18, 120, 36],
			['words', 40, 28, 60],
			['act', 40, 38, 36, 9],
			['card', 184, 18, 34, 44],
			['line', 'M192 18v-5h18v5M192 62v5h18v-5'],
			...lines(190, 34, [22, 16]),
			['card', 32, 60, 120, 16],
			['act', 116, 64, 28, 8],
			['card', 32, 82, 202, 24],
			...lines(40, 92, [70, 50])
		],
		places: [
			[84, 42],
			[222, 30],
			[110, 68],
			[226, 94]
		]
	},
	people: kept([
		[190, 40],
		[226, 64],
		[226, 88]
	]),
	keys: kept([
		[190, 40],
		[110, 36],
		[226, 64]
	]),
	webhooks: kept([
		[190, 40],
		[110, 36],
		[226, 76]
	]),
	backups: {
		shapes: [['card', 32, 18, 202, 22], ['ring', 41, 29, 3], ['words', 50, 29, 90], ['act', 196, 24, 30, 10], ...table(46, 5)],
		places: [
			[148, 28],
			[190, 28],
			[226, 60],
			[226, 90]
		]
	},
	storage: {
		shapes: [['card', 32, 18, 202, 52], ['past', 40, 28, 130, 8], ['soft', 40, 42, 70, 8], ['well', 40, 56, 186, 6], ['past', 40, 56, 120, 6], ['card', 32, 76, 202, 30], ...lines(40, 86, [90, 60]), ['act', 190, 82, 36, 10]],
		places: [
			[178, 32],
			[186, 87],
			[138, 94]
		]
	},
	account: {
		shapes: [['ring', 44, 26, 8], ...lines(58, 24, [50, 30]), ['card', 32, 40, 202, 20], ['words', 40, 50, 110], ['card', 32, 64, 202, 22], ['card', 40, 70, 70, 9], ['act', 116, 70, 34, 9], ['card', 32, 90, 202, 18], ['card', 40, 95, 34, 8]],
		places: [
			[226, 50],
			[156, 74],
			[82, 99]
		]
	}
};
