import { describe, expect, test, vi } from 'vitest';
import { Shell, filesOf, type Kept } from './shell.ts';

/** What a browser keeps. */
class Cache implements Kept {
	readonly all = new Map<string, Response>();
	match = (address: string): Promise<Response | undefined> => Promise.resolve(this.all.get(address)?.clone());
	put = async (address: string, response: Response): Promise<void> => void this.all.set(address, response);
	delete = (address: string): Promise<boolean> => Promise.resolve(this.all.delete(address));
	keys = (): Promise<{ url: string }[]> =>
		Promise.resolve([...this.all.keys()].map((address) => ({ url: `https://station${address}` })));
}

/** A server with one build of the page; `away` it answers nothing, `slow` not in time. */
class Server {
	files: Record<string, string> = {};
	state: 'there' | 'away' | 'slow' | 'proxied' = 'there';

	build(number: number): void {
		const script = `/_app/immutable/start.${number}.js`;
		this.files = {
			'/operator': `<link href=".${script}" rel="modulepreload"><script src="./theme.js"></script> import(".${script}")`,
			'/theme.js': `theme ${number}`,
			[script]: `script ${number}`,
			[`/_app/immutable/later.${number}.js`]: `later ${number}`
		};
	}

	load = (address: string): Promise<Response> => {
		if (this.state === 'away') return Promise.reject(new TypeError('refused'));
		if (this.state === 'slow') return new Promise(() => undefined);
		if (this.state === 'proxied') return Promise.resolve(new Response('bad gateway', { status: 502 }));
		const text = this.files[address];
		return Promise.resolve(new Response(text ?? 'none', { status: text === undefined ? 404 : 200 }));
	};
}

async function installed(): Promise<{ server: Server; cache: Cache; shell: Shell; open: () => Promise<string> }> {
	const [server, cache] = [new Server(), new Cache()];
	server.build(1);
	const shell = new Shell(cache, server.load);
	await shell.install();
	/** Opens the page and waits until what comes of it is over; its own text and that of its script. */
	const open = async (): Promise<string> => {
		const work: Promise<void>[] = [];
		const html = await (await shell.page((each) => work.push(each))).text();
		await Promise.allSettled(work);
		const script = filesOf(html).find((address) => address.includes('start')) ?? '';
		const texts = await Promise.all([script, '/theme.js'].map(async (each) => (await shell.file(each)).text()));
		return texts.join(', ');
	};
	return { server, cache, shell, open };
}

test('the files of a document are what it links to, loads and imports, each once', () => {
	const html = `<link href="./_app/a.css" rel="stylesheet"><script src="./theme.js"></script>
		<link rel="manifest" href="/manifest.webmanifest"><a href="/users">People</a> <a href="/">Operate</a>
		import("./_app/b.js").then(import("./_app/b.js"))`;
	expect(filesOf(html)).toEqual(['/_app/a.css', '/theme.js', '/manifest.webmanifest', '/_app/b.js']);
});

describe('the watch', () => {
	test.each(['away', 'proxied'] as const)('opens as it was kept while the server is %s', async (state) => {
		const { server, open } = await installed();
		server.state = state;
		expect(await open()).toBe('script 1, theme 1');
	});

	test('opens soon while the server does not answer', async () => {
		vi.useFakeTimers();
		const { server, shell } = await installed();
		server.state = 'slow';
		const opening = shell.page(() => undefined);
		await vi.advanceTimersByTimeAsync(1500);
		expect(await (await opening).text()).toContain('start.1');
		vi.useRealTimers();
	});

	test('is that of a new build as soon as there is one, also when the server goes away after that', async () => {
		const { server, open, cache } = await installed();
		server.build(2);
		expect(await open()).toBe('script 2, theme 2');
		server.state = 'away';
		expect(await open()).toBe('script 2, theme 2');
		expect([...cache.all.keys()].join()).not.toContain('1.js');
	});

	test('stays as it was while not all of a new build can be read', async () => {
		const { server, open } = await installed();
		server.build(2);
		delete server.files['/theme.js'];
		delete server.files['/_app/immutable/start.2.js'];
		await open();
		server.state = 'away';
		expect(await open()).toBe('script 1, theme 1');
	});

	test('keeps what it loads later', async () => {
		const { server, shell, open } = await installed();
		await shell.file('/_app/immutable/later.1.js');
		await open();
		server.state = 'away';
		expect(await (await shell.file('/_app/immutable/later.1.js')).text()).toBe('later 1');
	});

	test('keeps what it loads later also when the worker has begun anew since', async () => {
		const { server, shell, cache } = await installed();
		await shell.file('/_app/immutable/later.1.js');
		const anew = new Shell(cache, server.load);
		await anew.file('/_app/immutable/later.1.js');
		const work: Promise<void>[] = [];
		await anew.page((each) => work.push(each));
		await Promise.all(work);
		server.state = 'away';
		expect(await (await anew.file('/_app/immutable/later.1.js')).text()).toBe('later 1');
	});

	test('is not installed by half', async () => {
		const [server, cache] = [new Server(), new Cache()];
		server.build(1);
		delete server.files['/theme.js'];
		await expect(new Shell(cache, server.load).install()).rejects.toThrow('/theme.js is answered with 404');
		expect(cache.all.has('/operator')).toBe(false);
	});
});
