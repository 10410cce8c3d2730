/**
 * The editors of this page, made with CodeMirror: one for a condition or an action, one for a file.
 *
 * Each lives in a shadow root: there its styles are style sheets of the script, which the Content-Security-Policy allows,
 * where a `style` element in the document would be refused. This module is read only when an editor is shown.
 */
import { autocompletion, closeCompletion, completionKeymap, type CompletionContext, type CompletionResult } from '@codemirror/autocomplete';
import { defaultKeymap, history, historyKeymap } from '@codemirror/commands';
import { yaml } from '@codemirror/lang-yaml';
import { HighlightStyle, StreamLanguage, syntaxHighlighting } from '@codemirror/language';
import { linter, setDiagnostics, type Diagnostic } from '@codemirror/lint';
import { Compartment, EditorState, Prec, RangeSetBuilder, StateEffect, StateField, type ChangeSpec, type Extension } from '@codemirror/state';
import { Decoration, EditorView, hoverTooltip, keymap, lineNumbers, type DecorationSet } from '@codemirror/view';
import { tags } from '@lezer/highlight';
import type { Completion, Hover, Wrong } from './language.ts';

const THEME = EditorView.theme({
	'&': {
		minHeight: 'var(--editor-least, var(--ctl-h))',
		maxHeight: 'var(--editor-most, none)',
		border: '1px solid var(--edge)',
		borderRadius: 'var(--r-2)',
		background: 'var(--raised)',
		color: 'var(--ink)',
		fontSize: 'var(--t-small)'
	},
	'&.cm-focused': { outline: '2px solid var(--focus)', outlineOffset: '2px' },
	'.cm-scroller': { fontFamily: 'var(--mono)', fontFeatureSettings: "'calt' 0", lineHeight: '1.55' },
	'.cm-content': { padding: 'var(--editor-pad, 0.55rem) 0', caretColor: 'var(--ink)' },
	'.cm-line': { padding: '0 0.75rem' },
	'.cm-gutters': { background: 'var(--sunken)', color: 'var(--ink-2)', borderRight: '1px solid var(--line)' },
	'.cm-tooltip': {
		zIndex: '20',
		maxWidth: 'min(32rem, 90vw)',
		border: '1px solid var(--edge)',
		borderRadius: 'var(--r-2)',
		background: 'var(--surface)',
		color: 'var(--ink)',
		font: 'var(--t-small) / 1.4 var(--sans)'
	},
	'.cm-tooltip-hover, .cm-tooltip-lint': { padding: '0.25rem 0.5rem' },
	'.cm-tooltip p': { margin: '0' },
	'.cm-tooltip.cm-tooltip-autocomplete > ul': { fontFamily: 'var(--mono)', maxHeight: '16em' },
	'.cm-tooltip.cm-tooltip-autocomplete > ul > li': { padding: '0.35rem 0.6rem' },
	'.cm-tooltip-autocomplete ul li[aria-selected]': { background: 'var(--press)', color: 'var(--ink)' },
	'.cm-completionDetail': { color: 'var(--ink-2)', fontStyle: 'normal', fontFamily: 'var(--sans)' },
	'.cm-completionMatchedText': { fontWeight: '700' },
	'.cm-diagnostic': { borderLeft: '4px solid var(--high)', padding: '0.25rem 0.5rem' },
	'.cm-diagnostic-warning': { borderLeftColor: 'var(--medium)' },
	'.cm-lintRange-error': { backgroundImage: 'none', borderBottom: '3px double var(--high)' },
	'.cm-lintRange-warning': { backgroundImage: 'none', borderBottom: '3px dotted var(--medium)' },
	'.cm-chosen': { background: 'var(--accent-soft)', boxShadow: 'inset 2px 0 0 var(--accent)' },
	'.unseen': { position: 'absolute', clipPath: 'inset(50%)', width: '1px', height: '1px', overflow: 'hidden' }
});

/** Names by the accent and their weight, what is only for the reader by being quieter. */
const STYLE = HighlightStyle.define([
	{ tag: [tags.keyword, tags.operatorKeyword, tags.propertyName, tags.definition(tags.propertyName)], color: 'var(--accent-ink)', fontWeight: '600' },
	{ tag: [tags.comment, tags.meta], color: 'var(--ink-2)', fontStyle: 'italic' },
	{ tag: [tags.separator, tags.squareBracket, tags.brace, tags.punctuation], color: 'var(--ink-2)' }
]);

const EXPRESSIONS = StreamLanguage.define<null>({
	startState: () => null,
	token(stream) {
		if (stream.match(/^(?:and|or|not|implies|in|if|true|false)\b/) || stream.match(/^:=/)) return 'keyword';
		if (stream.match(/^[A-Za-z_][\w.]*/)) return 'variableName';
		if (stream.match(/^\d+(?:\.\d+)?/)) return 'number';
		if (stream.match(/^[()[\]{},]/)) return 'punctuation';
		stream.next();
		return null;
	}
});

/**
 * What is typed over bold letters would be made bold by the browser, with a style that the Content-Security-Policy
 * refuses: it is put there as plain text.
 */
function typedOver(event: InputEvent, view: EditorView): boolean {
	const { data } = event;
	if (event.inputType !== 'insertText' || event.isComposing || data === null || view.state.readOnly) return false;
	if (view.state.selection.ranges.length > 1) return false;
	const { from, to } = selected(view);
	if (from >= to) return false;
	const selection = { anchor: from + data.length };
	view.dispatch({ changes: { from, to, insert: data }, selection, userEvent: 'input.type', scrollIntoView: true });
	return true;
}

/** What is selected in the document, of which the editor may not have heard yet; not every browser tells it. */
function selected(view: EditorView): { from: number; to: number } {
	const { anchorNode, anchorOffset = 0, focusNode, focusOffset = 0 } =
		(view.root as Partial<Pick<Document, 'getSelection'>>).getSelection?.() ?? {};
	if (!anchorNode || !focusNode || ![anchorNode, focusNode].every((node) => view.contentDOM.contains(node)))
		return view.state.selection.main;
	const ends = [view.posAtDOM(anchorNode, anchorOffset), view.posAtDOM(focusNode, focusOffset)];
	return { from: Math.min(...ends), to: Math.max(...ends) };
}

/** A shadow root in `host`, and a place in it for words that belong to the editor. */
function rooted(host: HTMLElement): { root: ShadowRoot; note: HTMLElement } {
	const root = host.shadowRoot ?? host.attachShadow({ mode: 'open' });
	root.replaceChildren();
	const note = document.createElement('div');
	note.id = 'note';
	note.hidden = true; // what is not shown still describes
	root.append(note);
	return { root, note };
}

/** The smallest change that makes `now` of `was`, so that the cursor stays where it is. */
function changeTo(was: string, now: string): ChangeSpec | null {
	if (was === now) return null;
	let from = 0;
	while (from < was.length && from < now.length && was[from] === now[from]) from++;
	let end = 0;
	while (end < was.length - from && end < now.length - from && was.at(-1 - end) === now.at(-1 - end)) end++;
	return { from, to: was.length - end, insert: now.slice(from, now.length - end) };
}

export interface Editor {
	/** Shows another text; nothing is told of it. */
	show(text: string): void;
	/** Whether it can be written in. */
	lock(locked: boolean): void;
	focus(): void;
	destroy(): void;
}

interface Common {
	readonly label: string;
	readonly text: string;
	readonly locked: boolean;
	/** Something was written by a person. */
	readonly onwrite: (text: string) => void;
	/** The person has gone elsewhere. */
	readonly onleave: () => void;
}

/** What both editors have in common. */
function edited(host: HTMLElement, options: Common, more: Extension): { view: EditorView; editor: Editor; note: HTMLElement; attributes: Compartment } {
	const { root, note } = rooted(host);
	const lock = new Compartment();
	const attributes = new Compartment();
	let shows = false;
	const locked = (is: boolean): Extension => [EditorState.readOnly.of(is), EditorView.editable.of(true)];
	const view = new EditorView({
		root,
		parent: root,
		state: EditorState.create({
			doc: options.text,
			extensions: [
				THEME,
				syntaxHighlighting(STYLE),
				history(),
				keymap.of([...defaultKeymap, ...historyKeymap]),
				EditorView.lineWrapping,
				lock.of(locked(options.locked)),
				// What scrolls is reached by the keyboard through what is in it.
				EditorView.contentAttributes.of({ tabindex: '0' }),
				attributes.of(EditorView.contentAttributes.of({ 'aria-label': options.label })),
				more,
				EditorView.updateListener.of((update) => {
					if (update.docChanged && !shows) options.onwrite(update.state.doc.toString());
				}),
				EditorView.domEventHandlers({
					// One that is taken out of the page while it has the focus loses it in the midst of an update of the page.
					blur: (_, view) =>
						queueMicrotask(() => {
							if (view.dom.isConnected) closeCompletion(view);
							options.onleave();
						}),
					beforeinput: typedOver
				})
			]
		})
	});
	const editor: Editor = {
		show(text) {
			const change = changeTo(view.state.doc.toString(), text);
			if (change === null) return;
			shows = true;
			view.dispatch({ changes: change });
			shows = false;
		},
		lock(is) {
			view.dispatch({ effects: lock.reconfigure(locked(is)) });
		},
		focus: () => view.focus(),
		destroy: () => view.destroy()
	};
	return { view, editor, note, attributes };
}

export interface ExpressionOptions extends Common {
	readonly check: (text: string) => Promise<readonly Wrong[] | null>;
	readonly complete: (text: string, offset: number) => Promise<Completion | null>;
	readonly hover: (text: string, offset: number) => Promise<Hover | null>;
	readonly format: (text: string) => Promise<string | null>;
	/** Leads to where a name is declared, and to where what it names is used. */
	readonly define: (hover: Hover) => void;
	readonly usages: (hover: Hover) => void;
	/** The lines that are shown of what is named somewhere. */
	readonly about: (hover: Hover) => readonly string[];
	/** What is wrong with it now. */
	readonly onwrong: (wrong: readonly Wrong[]) => void;
	/** The person is done with it for now. */
	readonly onenter: () => void;
}

/** Something outside of the text has changed. */
const again = StateEffect.define<null>();

export interface ExpressionEditor extends Editor {
	/** Looks again for what is wrong: something else of the model has changed. */
	recheck(): void;
	/** Brings it into its usual form. */
	format(): Promise<void>;
}

/** Milliseconds without a key after which a text is looked at: somebody who types on is not asked about half a word. */
const REST = 120;
/** Milliseconds after which a text is looked at again where the server did not say what is wrong with it. */
const ASK_AGAIN = 3000;

export function expressionEditor(host: HTMLElement, options: ExpressionOptions): ExpressionEditor {
	let gone = false;
	async function format(): Promise<void> {
		const text = view.state.doc.toString();
		const form = text.trim() === '' || view.state.readOnly ? null : await options.format(text);
		const change = form === null || view.state.doc.toString() !== text ? null : changeTo(text, form);
		if (change !== null) view.dispatch({ changes: change, userEvent: 'format' });
	}

	/** Does something with the name at the cursor. */
	async function lead(where: (hover: Hover) => void): Promise<void> {
		const found = await options.hover(view.state.doc.toString(), view.state.selection.main.head);
		if (found !== null && !gone) where(found);
	}

	async function complete(context: CompletionContext): Promise<CompletionResult | null> {
		if (!context.explicit && context.matchBefore(/[\w.[=({]\s?$/) === null) return null;
		const found = await options.complete(context.state.doc.toString(), context.pos);
		if (found === null || context.aborted) return null;
		// What stands there already is no choice: Enter shall not wait for it.
		const isWritten = (text: string): boolean => found.options.some(({ insert }) => insert === text);
		const only = found.options.length === 1 && isWritten(context.state.sliceDoc(found.start, found.end));
		if (found.options.length === 0 || only) return null;
		return {
			from: found.start,
			to: found.end,
			options: found.options.map(({ label, insert, detail }) => ({ label, apply: insert, detail })),
			validFor: (text) => /^\w*$/.test(text) && !isWritten(text)
		};
	}

	let later: ReturnType<typeof setTimeout> | undefined;
	async function lint(): Promise<Diagnostic[]> {
		clearTimeout(later);
		const text = view.state.doc.toString();
		const wrong = text.trim() === '' ? [] : await options.check(text);
		if (gone) return [];
		if (wrong === null) later = setTimeout(() => view.dispatch({ effects: again.of(null) }), ASK_AGAIN);
		if (wrong === null || view.state.doc.toString() !== text) return [];
		options.onwrong(wrong);
		note.textContent = wrong.map(({ message }) => message).join('. ');
		view.dispatch({
			effects: attributes.reconfigure(
				EditorView.contentAttributes.of({
					'aria-label': options.label,
					...(wrong.length > 0 && { 'aria-invalid': 'true', 'aria-describedby': 'note' })
				})
			)
		});
		return wrong.map(({ start, end, message }) => {
			const from = Math.min(start, Math.max(0, text.length - 1));
			return { from, to: Math.min(text.length, Math.max(end, from + 1)), severity: 'error' as const, message };
		});
	}

	const { view, editor, note, attributes } = edited(host, options, [
		EXPRESSIONS,
		Prec.highest(keymap.of(completionKeymap)),
		Prec.high(keymap.of([
			{ key: 'F12', run: () => (void lead(options.define), true) },
			{ key: 'Shift-F12', run: () => (void lead(options.usages), true) },
			{ key: 'Shift-Alt-f', run: () => (void format(), true) },
			{ key: 'Enter', run: () => (options.onenter(), true) },
			{ key: 'Escape', run: closeCompletion }
		])),
		autocompletion({ override: [complete], icons: false, defaultKeymap: false }),
		linter(lint, { delay: REST, needsRefresh: ({ transactions }) => transactions.some(({ effects }) => effects.some((each) => each.is(again))) }),
		EditorView.clipboardInputFilter.of((text) => text.replaceAll(/\s*\n\s*/g, ' ')),
		hoverTooltip(async (_, at) => {
			const found = await options.hover(view.state.doc.toString(), at);
			if (found === null) return null;
			return {
				pos: found.start,
				end: found.end,
				above: true,
				create() {
					const dom = document.createElement('div');
					dom.append(
						...options.about(found).map((line) => {
							const said = document.createElement('p');
							said.textContent = line;
							return said;
						})
					);
					return { dom };
				}
			};
		})
	]);
	return {
		...editor,
		format,
		recheck: () => view.dispatch({ effects: again.of(null) }),
		destroy() {
			clearTimeout(later);
			gone = true;
			editor.destroy();
		}
	};
}

/** Something that is found in a file, on a line (from 1). */
export interface Mark {
	readonly line: number;
	readonly column: number;
	readonly message: string;
	readonly isError: boolean;
}

export interface FileOptions extends Common {
	/** Whether it is YAML. */
	readonly isYaml: boolean;
	/** The person has put the cursor on a line (from 1). */
	readonly onplace: (line: number) => void;
}

export interface FileEditor extends Editor {
	/** Marks the lines `from` to `to` (from 0, without the last), and scrolls there where `sight` is wanted. */
	choose(lines: { readonly from: number; readonly to: number } | null, sight: boolean): void;
	/** Underlines what was found. */
	underline(marks: readonly Mark[]): void;
	/** Puts the cursor on a line (from 1), in sight. */
	goTo(line: number, column: number): void;
}

/** Pixels above the line that is scrolled to. */
const MARGIN = 40;

const choose = StateEffect.define<{ from: number; to: number } | null>();
const chosen = StateField.define<DecorationSet>({
	create: () => Decoration.none,
	update(before, transaction) {
		let set = before.map(transaction.changes);
		for (const effect of transaction.effects) {
			if (!effect.is(choose)) continue;
			const builder = new RangeSetBuilder<Decoration>();
			const { doc } = transaction.state;
			for (let line = effect.value?.from ?? 1; line < (effect.value?.to ?? 0) && line < doc.lines; line++) {
				const { from } = doc.line(line + 1);
				builder.add(from, from, Decoration.line({ class: 'cm-chosen' }));
			}
			set = builder.finish();
		}
		return set;
	},
	provide: (field) => EditorView.decorations.from(field)
});

export function fileEditor(host: HTMLElement, options: FileOptions): FileEditor {
	const { view, editor } = edited(host, options, [
		lineNumbers(),
		chosen,
		...(options.isYaml ? [yaml()] : []),
		EditorView.theme({ '&': { height: '100%' }, '.cm-scroller': { overflow: 'auto' } }),
		EditorView.updateListener.of((update) => {
			if (update.transactions.some((each) => each.isUserEvent('select')))
				options.onplace(update.state.doc.lineAt(update.state.selection.main.head).number);
		})
	]);
	const lineAt = (number: number): { from: number; to: number } =>
		view.state.doc.line(Math.min(Math.max(1, number), view.state.doc.lines));
	return {
		...editor,
		choose(lines, sight) {
			view.dispatch({ effects: choose.of(lines) });
			if (!lines || !sight) return;
			// Only the editor is scrolled: what is chosen in the tree must not move the page.
			const { from } = lineAt(lines.from + 1);
			view.requestMeasure({
				read: () => view.lineBlockAt(from).top - MARGIN,
				write: (top) => (view.scrollDOM.scrollTop = top)
			});
		},
		underline(marks) {
			const found = marks.map(({ line, column, message, isError }): Diagnostic => {
				const { from, to } = lineAt(line);
				const start = Math.min(from + Math.max(0, column - 1), to);
				return { from: start, to: Math.max(start, to), severity: isError ? 'error' : 'warning', message };
			});
			view.dispatch(setDiagnostics(view.state, found));
		},
		goTo(line, column) {
			const { from, to } = lineAt(line);
			const at = Math.min(to, from + Math.max(0, column - 1));
			view.dispatch({ selection: { anchor: at }, effects: EditorView.scrollIntoView(at, { y: 'center' }) });
		}
	};
}
