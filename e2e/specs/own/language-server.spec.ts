/**
 * The language server as Visual Studio Code speaks to it: with its own libraries for the protocol, without its windows.
 */
import { expect, test } from '@playwright/test';
import { spawn, type ChildProcess } from 'node:child_process';
import { cpSync, readFileSync, rmSync, mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import {
	CodeActionRequest,
	CompletionRequest,
	createProtocolConnection,
	DefinitionRequest,
	DidChangeTextDocumentNotification,
	DidOpenTextDocumentNotification,
	ExitNotification,
	HoverRequest,
	InitializedNotification,
	InitializeRequest,
	InlayHintRequest,
	InlayHintRefreshRequest,
	PositionEncodingKind,
	PrepareRenameRequest,
	PublishDiagnosticsNotification,
	ReferencesRequest,
	RegistrationRequest,
	RenameRequest,
	ResponseError,
	ShutdownRequest,
	StreamMessageReader,
	StreamMessageWriter,
	type CodeAction,
	type CompletionList,
	type Diagnostic,
	type InitializeResult,
	type Position,
	type ProtocolConnection
} from 'vscode-languageserver-protocol/node';
import { EXECUTABLE, ROOT } from '../../station/station.ts';

/** The document that is open, as an editor keeps it. */
class Written {
	#version = 1;

	constructor(
		private readonly connection: ProtocolConnection,
		readonly uri: string,
		public text: string
	) {
		const textDocument = { uri, languageId: 'yaml', version: 1, text };
		void connection.sendNotification(DidOpenTextDocumentNotification.type, { textDocument });
	}

	/** Where the first `mark` ends, or so many characters into it. */
	at(mark: string, offset = mark.length): Position {
		const before = this.text.slice(0, this.text.indexOf(mark) + offset).split('\n');
		return { line: before.length - 1, character: before.at(-1)?.length ?? 0 };
	}

	async type(old: string, now: string): Promise<void> {
		const range = { start: this.at(old, 0), end: this.at(old) };
		this.text = this.text.replace(old, () => now);
		this.#version += 1;
		const textDocument = { uri: this.uri, version: this.#version };
		await this.connection.sendNotification(DidChangeTextDocumentNotification.type, {
			textDocument,
			contentChanges: [{ range, text: now }]
		});
	}

	place(mark: string, offset?: number): { textDocument: { uri: string }; position: Position } {
		return { textDocument: { uri: this.uri }, position: this.at(mark, offset) };
	}

	written({ start, end }: { start: Position; end: Position }): string {
		return this.text.split('\n')[start.line]?.slice(start.character, end.character) ?? '';
	}
}

let folder: string;
let program: ChildProcess;
let connection: ProtocolConnection;
let told: InitializeResult;
let hintsAreNew: boolean;
const shown = new Map<string, readonly Diagnostic[]>();

test.beforeEach(async () => {
	folder = mkdtempSync(join(tmpdir(), 'language-server-'));
	cpSync(join(ROOT, 'models/bolt_tightening'), join(folder, 'station'), { recursive: true });
	cpSync(join(ROOT, 'models/robots_with_buffer'), join(folder, 'robots'), { recursive: true });
	program = spawn(EXECUTABLE, ['language-server'], { stdio: ['pipe', 'pipe', 'inherit'] });
	if (program.stdout === null || program.stdin === null) throw new Error('the program has no streams');
	connection = createProtocolConnection(new StreamMessageReader(program.stdout), new StreamMessageWriter(program.stdin));
	shown.clear();
	hintsAreNew = false;
	connection.onNotification(PublishDiagnosticsNotification.type, ({ uri, diagnostics }) => void shown.set(uri, diagnostics));
	connection.onRequest(RegistrationRequest.type, () => undefined);
	connection.onRequest(InlayHintRefreshRequest.type, () => void (hintsAreNew = true));
	connection.listen();
	told = await connection.sendRequest(InitializeRequest.type, {
		processId: process.pid,
		rootUri: pathToFileURL(folder).href,
		capabilities: {
			general: { positionEncodings: [PositionEncodingKind.UTF16] },
			workspace: {
				inlayHint: { refreshSupport: true },
				didChangeWatchedFiles: { dynamicRegistration: true },
				workspaceEdit: { documentChanges: true, resourceOperations: ['create', 'rename', 'delete'] }
			}
		}
	});
	await connection.sendNotification(InitializedNotification.type, {});
});

test.afterEach(async () => {
	await connection.sendRequest(ShutdownRequest.type);
	const ended = new Promise((resolve) => program.once('exit', resolve));
	await connection.sendNotification(ExitNotification.type);
	expect(await ended).toBe(0);
	connection.dispose();
	rmSync(folder, { recursive: true });
});

const open = (file: string, station = 'station'): Written => {
	const path = join(folder, station, file);
	return new Written(connection, pathToFileURL(path).href, readFileSync(path, 'utf8'));
};

/** What is wrong, in words. */
const said = ({ message }: Diagnostic): string => (typeof message === 'string' ? message : message.value);

const wrong = async (document: Written, part: string): Promise<Diagnostic> => {
	const found = (): Diagnostic | undefined => shown.get(document.uri)?.find((each) => said(each).includes(part));
	await expect.poll(() => found() !== undefined, { timeout: 30_000 }).toBe(true);
	return found() as Diagnostic;
};

test('a wrong name is underlined, in a condition and in a set, and mended by what is proposed', async () => {
	expect(told.capabilities.positionEncoding).toBe('utf-16');
	const nutrunner = open('resources/nutrunner.yaml');
	await nutrunner.type('robot.pose == bolt_pair_1 and', 'robot.pos == bolt_pair_1 and');
	const first = await wrong(nutrunner, 'unknown variable `robot.pos`');
	expect(nutrunner.written(first.range)).toBe('robot.pos');

	const actions = await connection.sendRequest(CodeActionRequest.type, {
		textDocument: { uri: nutrunner.uri },
		range: first.range,
		context: { diagnostics: [first] }
	});
	const fix = actions?.find((each): each is CodeAction => 'edit' in each && each.title === 'Write `robot.pose`');
	const edit = fix?.edit?.changes?.[nutrunner.uri]?.[0];
	expect(edit?.newText).toBe('robot.pose');
	await nutrunner.type('robot.pos == bolt_pair_1 and', `${edit?.newText} == bolt_pair_1 and`);
	await expect.poll(() => shown.get(nutrunner.uri)?.length).toBe(0);

	const station = open('station.yaml');
	await station.type('\n# No sensor', '\nsets:\n  at_pairs: {of: pose, values: [bolt_pair_1, bolt_pair_22]}\n\n# No sensor');
	const second = await wrong(station, 'bolt_pair_22');
	expect(station.written(second.range)).toBe('bolt_pair_22');
});

test('a wrong name is underlined in a set used inside a resource type, and where the type uses it', async () => {
	const station = open('station.yaml', 'robots');
	await station.type('\n# No sensor', '\nsets:\n  conveyors: {of: place, except: [between, buffer]}\n\n# No sensor');
	const type = open('types/robot.yaml', 'robots');
	await type.type('enabled: at == target and', 'enabled: at == target and not at in conveyors and');
	await expect.poll(() => shown.get(type.uri)?.length ?? 0, { timeout: 30_000 }).toBe(0);

	await station.type('except: [between, buffer]', 'except: [between, bufer]');
	const inSet = await wrong(station, 'bufer');
	expect(station.written(inSet.range)).toBe('bufer');
	expect(said(inSet)).toContain('did you mean `buffer`?');
	await station.type('except: [between, bufer]', 'except: [between, buffer]');

	await type.type('not at in conveyors', 'not at in conveyers');
	const inType = await wrong(type, 'there is no set `conveyers`');
	expect(type.written(inType.range)).toBe('conveyers');
	expect(said(inType)).toContain('did you mean `conveyors`?');
	const actions = await connection.sendRequest(CodeActionRequest.type, {
		textDocument: { uri: type.uri },
		range: inType.range,
		context: { diagnostics: [inType] }
	});
	const fix = actions?.find((each): each is CodeAction => 'edit' in each && each.title === 'Write `conveyors`');
	expect(fix?.edit?.changes?.[type.uri]?.[0]?.newText).toBe('conveyors');
	await type.type('not at in conveyers', 'not at in conveyors');
	await expect.poll(() => shown.get(type.uri)?.length ?? 0, { timeout: 30_000 }).toBe(0);

	const options = (await connection.sendRequest(CompletionRequest.type, type.place('not at in conv'))) as CompletionList;
	expect(options.items.map((each) => each.label)).toContain('conveyors');
	const hover = await connection.sendRequest(HoverRequest.type, type.place('initial: conveyor'));
	expect(JSON.stringify(hover?.contents)).toContain('infeed in robot_1, outfeed in robot_2');
	const edit = await connection.sendRequest(RenameRequest.type, { ...station.place('  conveyors:', 4), newName: 'belts' });
	const files = Object.keys(edit?.changes ?? {}).map((each) => each.split('/').at(-1));
	expect(files.toSorted()).toEqual(['robot.yaml', 'station.yaml']);
});

test('names are completed, explained, found and renamed', async () => {
	const nutrunner = open('resources/nutrunner.yaml');
	await nutrunner.type('executing: tool_is_running_forward', 'executing: robot.');
	const options = (await connection.sendRequest(CompletionRequest.type, nutrunner.place('executing: robot.'))) as CompletionList;
	expect(options.items.map((each) => each.label)).toContain('robot.pose');
	await nutrunner.type('executing: robot.', 'executing: tool_is_running_forward');

	const hover = await connection.sendRequest(HoverRequest.type, nutrunner.place('robot.pose', 8));
	expect(JSON.stringify(hover?.contents)).toContain('robot.pose');
	const places = (await connection.sendRequest(DefinitionRequest.type, nutrunner.place('robot.pose', 8))) as { uri: string }[];
	expect(places.map((each) => each.uri)).toEqual([pathToFileURL(join(folder, 'station/resources/robot.yaml')).href]);

	const uses = await connection.sendRequest(ReferencesRequest.type, {
		...nutrunner.place('robot.pose', 8),
		context: { includeDeclaration: true }
	});
	expect(new Set(uses?.map((each) => each.uri)).size).toBeGreaterThan(2);

	const ability = nutrunner.place('  run_nut:', 4);
	expect(await connection.sendRequest(PrepareRenameRequest.type, ability)).toMatchObject({ placeholder: 'run_nut' });
	const edit = await connection.sendRequest(RenameRequest.type, { ...ability, newName: 'tighten' });
	const files = Object.keys(edit?.changes ?? {}).map((each) => each.split('/').at(-1));
	expect(files.toSorted()).toEqual(['nutrunner.yaml', 'specifications.yaml', 'work.yaml']);
	const refused = connection.sendRequest(RenameRequest.type, { ...ability, newName: 'two words' });
	await expect(refused).rejects.toThrow(ResponseError);
	await expect(refused).rejects.toThrow('is no name');
});

test('what the supervisor adds stands beside the starts', async () => {
	const robot = open('resources/robot.yaml');
	await expect.poll(() => hintsAreNew, { timeout: 60_000 }).toBe(true);
	const hints = await connection.sendRequest(InlayHintRequest.type, {
		textDocument: { uri: robot.uri },
		range: { start: { line: 0, character: 0 }, end: { line: 999, character: 0 } }
	});
	expect(hints?.map((each) => each.label).join('\n')).toContain('supervisor: operator.requested_pair != position and ');
});
