/** Begins the page of all parts, beside a station that is heard, or with `?old` in its address was. */
import { mount } from 'svelte';
import '#lib/style/fonts.css';
import '#lib/style/tokens.css';
import '#lib/style/base.css';
import type { StreamMessage } from '#lib/contract.ts';
import { view } from '#lib/testing/view.ts';
import { en } from '#lib/text/en.ts';
import { sv } from '#lib/text/sv.ts';
import { furnish } from '#lib/text/text.svelte.ts';
import Kit from './kit.svelte';

/** A stream on which the controller shows itself twice, as what was heard once only may be old; then five times a second. */
class Stream extends EventTarget {
	static readonly CONNECTING = 0;
	readonly readyState = 1;
	onopen: (() => void) | null = null;
	onmessage: ((event: { data: string }) => void) | null = null;
	onclose: ((event: { code: number }) => void) | null = null;
	#sequence = 0;
	readonly #timer = setInterval(() => this.#tell(), 200);

	#tell(): void {
		const time = 1000 + this.#sequence / 5;
		if (this.#sequence === 0) this.onopen?.();
		const message: StreamMessage =
			this.#sequence === 0
				? { kind: 'snapshot', sequence: 0, age: null, view: view({ time }) }
				: { kind: 'delta', sequence: this.#sequence, changed: { time }, removed: {} };
		this.onmessage?.({ data: JSON.stringify(message) });
		this.#sequence += 1;
		if (new URLSearchParams(location.search).has('old') && this.#sequence > 2) this.close();
	}

	send(): void {
		// Nobody hears it.
	}

	close(): void {
		clearInterval(this.#timer);
	}
}

Object.assign(window, { WebSocket: Stream });
await furnish({ en: () => en, sv: () => sv });
const target = document.getElementById('page');
if (target) mount(Kit, { target });
