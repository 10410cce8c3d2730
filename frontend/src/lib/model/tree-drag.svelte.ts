/** Dragging rows of the tree with a mouse, a pen or by their grip: from the press to where they are let go. */
import { dropAt, type Drop } from './dragging.ts';
import type { Target } from './together.ts';
import type { Node, Row } from './tree.ts';

/** Pixels after which a press is a drag. */
const FAR = 5;
/** Pixels from an edge of the tree at which it scrolls, and by how many with each frame. */
const [EDGE, STEP] = [28, 8];

interface Tree {
	readonly rows: () => readonly Row[];
	readonly host: () => HTMLElement | undefined;
	/** What goes with the row that is pressed; null where it cannot be dragged, which has been said then. */
	readonly taken: (node: Node) => readonly Node[] | null;
	readonly scroll: (by: number) => void;
	readonly put: (nodes: readonly Node[], target: Target) => void;
}

export class TreeDrag {
	readonly #tree: Tree;
	/** What is dragged; empty while nothing is. */
	nodes = $state.raw<readonly Node[]>([]);
	drop = $state.raw<Drop | null>(null);
	/** Where the pointer is, in the tree. */
	at = $state.raw<{ readonly x: number; readonly y: number }>({ x: 0, y: 0 });
	#from: { readonly x: number; readonly y: number; readonly node: Node; readonly pointer: number } | null = null;
	#last = { x: NaN, y: NaN };
	#frame = 0;

	constructor(tree: Tree) {
		this.#tree = tree;
	}

	get active(): boolean {
		return this.nodes.length > 0;
	}

	/** A row is pressed: it may become a drag. */
	press(event: PointerEvent): void {
		const target = event.target instanceof Element ? event.target : null;
		const id = target?.closest<HTMLElement>('[data-id]')?.dataset['id'];
		const row = this.#tree.rows().find(({ node }) => node.id === id);
		const isPlain = event.button === 0 && event.isPrimary && !event.ctrlKey && !event.metaKey && !event.shiftKey && !event.altKey;
		// A finger scrolls the tree, unless it is on the grip.
		if (!row || !isPlain || (event.pointerType === 'touch' && !target?.closest('[data-grip]')) || target?.closest('[data-toggle]')) return;
		this.#from = { x: event.clientX, y: event.clientY, node: row.node, pointer: event.pointerId };
	}

	move(event: PointerEvent): void {
		const from = this.#from;
		if (from?.pointer !== event.pointerId) return;
		if (!this.active) {
			if (Math.hypot(event.clientX - from.x, event.clientY - from.y) < FAR) return;
			const nodes = this.#tree.taken(from.node);
			if (nodes === null) return void (this.#from = null);
			this.nodes = nodes;
			this.#tree.host()?.setPointerCapture(event.pointerId);
			this.#frame = requestAnimationFrame(() => this.#scroll());
		}
		// What comes above the tree, such as that the connection is lost, moves it under a hand that rests: the line stays at its row.
		if (event.clientX === this.#last.x && event.clientY === this.#last.y) return;
		this.#aim(event.clientX, event.clientY);
	}

	/** It is let go: what is dragged is put where the line is. */
	release(event: PointerEvent): void {
		if (this.#from?.pointer !== event.pointerId) return;
		const { nodes, drop } = this;
		this.cancel();
		if (drop) this.#tree.put(nodes, drop);
	}

	/** All stays as it was. */
	cancel(): void {
		cancelAnimationFrame(this.#frame);
		this.#from = null;
		this.nodes = [];
		this.drop = null;
	}

	#aim(x: number, y: number): void {
		const host = this.#tree.host();
		if (!host) return;
		this.#last = { x, y };
		const box = host.getBoundingClientRect();
		this.at = { x: x - box.left, y: y - box.top };
		const over = document.elementFromPoint(Math.min(Math.max(x, box.left + 4), box.right - 4), y)?.closest<HTMLElement>('[data-id]');
		const rows = this.#tree.rows();
		const place = over && host.contains(over) ? rows.findIndex(({ node }) => node.id === over.dataset['id']) : -1;
		const { top = 0, height = 0 } = over?.getBoundingClientRect() ?? {};
		this.drop = place < 0 ? null : dropAt(rows, this.nodes, place, y < top + height / 2);
	}

	/** At its edges the tree goes on, and what is under the pointer with it. */
	#scroll(): void {
		const host = this.#tree.host();
		if (!host || !this.active) return;
		const { top, bottom, left } = host.getBoundingClientRect();
		const y = this.at.y + top;
		const by = y < top + EDGE ? -STEP : y > bottom - EDGE ? STEP : 0;
		if (by !== 0) {
			this.#tree.scroll(by);
			this.#aim(this.at.x + left, y);
		}
		this.#frame = requestAnimationFrame(() => this.#scroll());
	}
}
