/**
 * Whether a watch is round or rectangular. Few browsers tell it: a screen that is longer one way than the other is no round
 * one, and one that is not is taken for round, of which a rectangular one shows all too. Who wears it can say better.
 */
export type Shape = 'round' | 'square';

const KEY = 'watch-shape';

/** The shape that was chosen, else as the screen tells it, else as its sides are. */
export function shapeOf(chosen: string | null, told: Shape | null, [width, height]: readonly [number, number]): Shape {
	if (chosen === 'round' || chosen === 'square') return chosen;
	// A bar of the browser's own takes a little of a round screen.
	return told ?? (Math.abs(width - height) * 20 <= width ? 'round' : 'square');
}

export class ScreenShape {
	#chosen: string | null = kept();
	#is = $state<Shape>(this.#look());
	readonly is: Shape = $derived(this.#is);

	/** Looks at the screen whenever it changes; the result ends that. */
	attach(): () => void {
		const look = (): Shape => (this.#is = this.#look());
		addEventListener('resize', look);
		return () => removeEventListener('resize', look);
	}

	/** From now on it is `shape`. */
	choose(shape: Shape): void {
		this.#is = this.#chosen = shape;
		try {
			localStorage.setItem(KEY, shape);
		} catch {
			// It lasts as long as the page then.
		}
	}

	#look(): Shape {
		const tells = (shape: string): boolean => matchMedia(`(shape: ${shape})`).matches;
		return shapeOf(this.#chosen, tells('round') ? 'round' : tells('rect') ? 'square' : null, [innerWidth, innerHeight]);
	}
}

function kept(): string | null {
	try {
		return localStorage.getItem(KEY);
	} catch {
		return null;
	}
}
