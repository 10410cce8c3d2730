/**
 * A station under test: server, controller and emulated devices, started as a person starts them.
 *
 * `SEQUENCE_PLANNER` names another executable than the one that `make run` installs.
 */
import { spawnSync } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer, type Server } from 'node:net';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { StationProcess } from './process.ts';

export const ROOT = resolve(import.meta.dirname, '../..');
const MODEL = 'models/bolt_tightening';
export const EXECUTABLE = process.env['SEQUENCE_PLANNER'] ?? join(ROOT, 'backend/.venv/bin/sequence-planner');
/** Milliseconds until the server must answer. */
const START = 60_000;

/** Somebody who may sign in; the password is one of a test alone, and changed to it at the first sign-in. */
export interface Person {
	readonly name: string;
	readonly role: 'viewer' | 'operator' | 'engineer' | 'administrator';
	readonly password: string;
}

/** Who has signed in on the pages of tests that are about something else. */
export const EVA: Person = { name: 'Eva', role: 'operator', password: 'seven green apples' };
export const ADAM: Person = { name: 'Adam', role: 'operator', password: 'three grey herons' };
export const ERIK: Person = { name: 'Erik', role: 'engineer', password: 'four copper kettles' };
export const VERA: Person = { name: 'Vera', role: 'viewer', password: 'nine quiet harbours' };
export const INA: Person = { name: 'Ina', role: 'engineer', password: 'eight amber lanterns' };
export const IVO: Person = { name: 'Ivo', role: 'engineer', password: 'four wide rivers' };
export const ADA: Person = { name: 'Ada', role: 'administrator', password: 'two wooden bridges' };

/** A connection is not kept: whoever waits for a process does not see that the server has closed it meanwhile. */
const ALONE = { Connection: 'close' } as const;

export interface Cookie {
	readonly name: string;
	readonly value: string;
}

/** The temporary password with which somebody is made. */
const given = (password: string): string => `${password}, for now`;

export interface Options {
	/**
	 * Starts emulated devices with the server and production by itself, as a demonstration; else a test does both, and
	 * people sign in.
	 */
	readonly byItself: boolean;
	/** Starts emulated devices with a server that does not start by itself. */
	readonly devices: boolean;
	/** Who can sign in where it does not start by itself. */
	readonly people: readonly Person[];
	/** Where the output of all processes is kept. */
	readonly logs: string;
	/** The folder of another model than the usual one. */
	readonly model?: string;
	/** The name of a model of which the station has a copy, which may be changed. */
	readonly copied?: string | null;
	/** Further variables of the environment in which it is started. */
	readonly environment?: Readonly<Record<string, string>>;
	/** The port that it has; else one that is free. */
	readonly port?: number;
	/** A program that is started beside the station, on its network. */
	readonly beside?: readonly [command: string, args: readonly string[]];
}

/** The port of a domain's mark, less its number. */
const MARKS = 7000;
/** Above it the ports of a domain are those that the system hands out to anybody. */
const DOMAINS = 100;
/** How many domains were looked at: one that was left is not taken at once, while others may still know who was there. */
let looked = process.pid;

/** A DDS domain of this machine that a station has for itself. */
class Domain {
	readonly #mark: Server;

	private constructor(
		readonly number: number,
		mark: Server
	) {
		this.#mark = mark;
	}

	/** One that no other station under test has, in this run or another: a port that it listens on says so. */
	static async free(): Promise<Domain> {
		for (let tries = 0; tries < DOMAINS; tries += 1) {
			looked += 1;
			const number = 1 + (looked % DOMAINS);
			const mark = createServer();
			const listens = new Promise<boolean>((told) => {
				mark.once('error', () => told(false));
				mark.listen(MARKS + number, '127.0.0.1', () => told(true));
			});
			if (await listens) return new Domain(number, mark);
		}
		throw new Error('all DDS domains have a station');
	}

	async leave(): Promise<void> {
		await new Promise((left) => this.#mark.close(left));
	}
}

export class Station {
	readonly #env: NodeJS.ProcessEnv;
	readonly #domain: Domain;
	readonly #logs: string;
	readonly #started: StationProcess[] = [];
	/** Where the database of a station is that is no demonstration. */
	readonly #folder = mkdtempSync(join(tmpdir(), 'station-'));
	readonly #demonstration: boolean;
	/** The folder of the model, from where it was started. */
	readonly model: string;
	#cookie: string | null = null;
	readonly server: StationProcess;

	private constructor(
		readonly port: number,
		domain: Domain,
		options: Options
	) {
		this.#domain = domain;
		const database = options.byItself ? {} : { SEQUENCE_PLANNER_DATABASE: `sqlite:///${this.#folder}/station.sqlite` };
		this.#env = { ...process.env, ROS_DOMAIN_ID: String(domain.number), ...database, ...options.environment };
		this.#logs = options.logs;
		this.#demonstration = options.byItself;
		this.model = options.copied ? this.#copy(options.copied) : (options.model ?? MODEL);
		const devices = options.byItself || options.devices ? ['--emulator', '--emulator-speed', '4'] : [];
		const alone = options.byItself ? ['--start', '--demonstration'] : [];
		this.server = this.#start('server', ['run', this.model, '--port', String(port), ...devices, ...alone]);
		if (options.beside) this.#start('beside', [...options.beside[1]], options.beside[0]);
	}

	/** Starts a station and waits until it answers. */
	static async start(options: Options): Promise<Station> {
		const station = new Station(options.port ?? (await freePort()), await Domain.free(), options);
		try {
			await station.#answers();
			if (!options.byItself) await station.#let(options.people);
		} catch (error) {
			await station.stop();
			throw error;
		}
		return station;
	}

	get url(): string {
		return `http://127.0.0.1:${this.port}`;
	}

	/** Makes the first somebody who can sign in, as who sits at the machine does; the first makes the others. */
	async #let([first, ...others]: readonly Person[]): Promise<void> {
		if (!first) return;
		await this.add(first);
		if (others.length === 0) return;
		const cookie = await this.signIn(first);
		for (const person of others) {
			await this.#ask('POST', 'users', { ...person, password: given(person.password) }, cookie);
			await this.#chooses(person);
		}
	}

	/** Makes somebody who can sign in, as who sits at the machine does. */
	async add(person: Person): Promise<void> {
		const { name, role, password } = person;
		const args = ['users', 'add', name, '--role', role, this.model];
		const input = `${given(password)}\n`;
		const ended = spawnSync(EXECUTABLE, args, { cwd: ROOT, env: this.#env, input, encoding: 'utf8' });
		if (ended.status !== 0) throw new Error(`${args.join(' ')}: ${ended.stderr}`);
		await this.#chooses(person);
	}

	/** Somebody chooses their own password. */
	async #chooses({ name, password }: Person): Promise<void> {
		const cookie = await this.#session('POST', 'session', { name, password: given(password) });
		await this.#session('PUT', 'session/password', { old: given(password), new: password }, cookie);
	}

	/** The first-start link, as it is shown to who sits at the machine. */
	link(): string {
		const args = ['users', 'setup-link', this.model, '--url', this.url];
		const ended = spawnSync(EXECUTABLE, args, { cwd: ROOT, env: this.#env, encoding: 'utf8' });
		const [link] = /https?:\S+#\S+/.exec(ended.stdout) ?? [];
		if (link === undefined) throw new Error(`${args.join(' ')}: ${ended.stdout}${ended.stderr}`);
		return link;
	}

	/** Signs somebody in, or opens a demonstration: the cookie of the new session. */
	signIn(person: Person | null): Promise<Cookie> {
		if (person === null) return this.#session('POST', 'session/demonstration', {});
		return this.#session('POST', 'session', { name: person.name, password: person.password });
	}

	/** A request that opens a session: its cookie. */
	async #session(method: string, path: string, body: object, cookie?: Cookie): Promise<Cookie> {
		const answer = await this.#ask(method, path, body, cookie);
		const [name, value] = answer.headers.get('set-cookie')?.split(';')[0]?.split('=') ?? [];
		if (name === undefined || value === undefined) throw new Error(`${path}: no session was opened`);
		return { name, value };
	}

	async #ask(method: string, path: string, body: object, cookie?: Cookie): Promise<Response> {
		const answer = await fetch(`${this.url}/api/v1/${path}`, {
			method,
			headers: {
				...ALONE,
				'Content-Type': 'application/json',
				...(cookie && { Cookie: `${cookie.name}=${cookie.value}` })
			},
			body: JSON.stringify(body)
		});
		if (!answer.ok) throw new Error(`${method} ${path}: ${await answer.text()}`);
		return answer;
	}

	/** Starts emulated devices in a process of their own. */
	emulate(): StationProcess {
		return this.#start('emulator', ['emulate', this.model]);
	}

	/** The values of all variables as the server knows them, in the words of the page. */
	async values(): Promise<[name: string, value: string][]> {
		if (this.#cookie === null) {
			const { name, value } = await this.signIn(this.#demonstration ? null : EVA);
			this.#cookie = `${name}=${value}`;
		}
		const answer = await fetch(`${this.url}/api/v1/state`, { headers: { Cookie: this.#cookie } });
		const { variables } = (await answer.json()) as { variables: Record<string, { value: unknown }> };
		return Object.entries(variables).map(([name, { value }]) => [name, value === null ? 'unknown' : String(value)]);
	}

	/** Moves an emulated device, as somebody might move a real one: `robot.pose := home`. */
	async byHand(change: string): Promise<void> {
		const code = await this.#start('by-hand', ['by-hand', change]).ended();
		if (code !== 0) throw new Error(`${change} by hand ended with ${code}; see ${this.#logs}`);
	}

	/** Lets an emulated device have a fault, `robot silent`, or ends faults: `clear`. */
	async fault(line: string): Promise<void> {
		const code = await this.#start('fault', ['fault', line]).ended();
		if (code !== 0) throw new Error(`the fault ${line} ended with ${code}; see ${this.#logs}`);
	}

	/** Stops all that was started; an error when a process had to be forced. */
	async stop(): Promise<void> {
		const ends = await Promise.allSettled(this.#started.map((running) => running.stop()));
		const failed = ends.find((end) => end.status === 'rejected');
		await this.#domain.leave();
		rmSync(this.#folder, { recursive: true });
		if (failed) throw failed.reason;
	}

	/** It keeps its name: the station is called after it. */
	#copy(name: string): string {
		const model = join(this.#folder, name);
		cpSync(join(ROOT, 'models', name), model, { recursive: true });
		return model;
	}

	#start(name: string, args: string[], command = EXECUTABLE): StationProcess {
		const log = join(this.#logs, `${name}.log`);
		const started = new StationProcess(command, args, { cwd: ROOT, env: this.#env, log });
		this.#started.push(started);
		return started;
	}

	async #answers(): Promise<void> {
		const deadline = Date.now() + START;
		while (Date.now() < deadline && this.server.running) {
			try {
				const answer = await fetch(`${this.url}/healthz`, { headers: ALONE, signal: AbortSignal.timeout(2000) });
				if (answer.ok) return;
			} catch {
				// Not listening yet.
			}
			await sleep(200);
		}
		const said = readFileSync(this.server.log, 'utf8').slice(-2000);
		throw new Error(`The station did not start (${EXECUTABLE}). It said:\n${said}`);
	}
}

export async function freePort(): Promise<number> {
	const probe = createServer();
	await new Promise<void>((resolve) => probe.listen(0, '127.0.0.1', resolve));
	const address = probe.address();
	await new Promise((resolve) => probe.close(resolve));
	if (address === null || typeof address === 'string') throw new Error('no port was given');
	return address.port;
}
