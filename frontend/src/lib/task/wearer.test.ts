import { afterEach, expect, test, vi } from 'vitest';
import { buzz, keepAwake } from './wearer.ts';

afterEach(() => vi.unstubAllGlobals());

/** A device with a page in front or behind, which tells how many locks on its screen are held. */
function device(refuses = false): { locks: () => number; show: (state: 'visible' | 'hidden') => Promise<void> } {
	const page = Object.assign(new EventTarget(), { visibilityState: 'visible' });
	const held = new Set<object>();
	const request = (): Promise<object> => {
		if (refuses) return Promise.reject(new Error('the battery is low'));
		const lock = { release: (): Promise<void> => Promise.resolve(void held.delete(lock)) };
		held.add(lock);
		return Promise.resolve(lock);
	};
	vi.stubGlobal('document', page);
	vi.stubGlobal('navigator', { wakeLock: { request } });
	return {
		locks: () => held.size,
		show: async (state) => {
			if (state === 'hidden') held.clear(); // the browser takes it back
			page.visibilityState = state;
			page.dispatchEvent(new Event('visibilitychange'));
			await Promise.resolve();
		}
	};
}

test('the screen stays on while it is wanted, also after the page was away', async () => {
	const { locks, show } = device();
	const end = keepAwake();
	await vi.waitFor(() => expect(locks()).toBe(1));
	await show('hidden');
	expect(locks()).toBe(0);
	await show('visible');
	await vi.waitFor(() => expect(locks()).toBe(1));
	end();
	expect(locks()).toBe(0);
	await show('visible');
	expect(locks()).toBe(0);
});

test('a lock that is given after it was wanted is given back', async () => {
	const { locks } = device();
	keepAwake()();
	await vi.waitFor(() => expect(locks()).toBe(0));
});

test('where the browser refuses, or cannot, nothing else is disturbed', async () => {
	const { locks } = device(true);
	const end = keepAwake();
	await Promise.resolve();
	expect(locks()).toBe(0);
	end();
	vi.stubGlobal('navigator', {});
	keepAwake()();
	buzz();
});

test('it is felt once the page was touched, and not before', () => {
	const vibrate = vi.fn();
	vi.stubGlobal('navigator', { vibrate, userActivation: { hasBeenActive: false } });
	buzz();
	expect(vibrate).not.toHaveBeenCalled();
	vi.stubGlobal('navigator', { vibrate, userActivation: { hasBeenActive: true } });
	buzz();
	expect(vibrate).toHaveBeenCalledOnce();
});
