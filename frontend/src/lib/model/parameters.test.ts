import fc from 'fast-check';
import { expect, test } from 'vitest';
import { areParameters, isDefault, parametersIn, parameterTaken, parameterWritten, rangesFor, type Parameter } from './parameters.ts';

const FILE = 'types/belt.yaml';
const CONTENT = {
	title: 'Belt',
	parameters: { namespace: 'text', loads: 'enumeration', nothing: { kind: 'value', of: 'loads' }, travel: { kind: 'number', default: 3 } }
};
const [NAMESPACE, LOADS, NOTHING, TRAVEL] = parametersIn(CONTENT.parameters) as [Parameter, Parameter, Parameter, Parameter];

test('each is shown by its kind, its range and its default', () => {
	expect(NAMESPACE).toEqual({ name: 'namespace', kind: 'text', of: '', otherwise: '' });
	expect(NOTHING).toEqual({ name: 'nothing', kind: 'value', of: 'loads', otherwise: '' });
	expect(TRAVEL).toEqual({ name: 'travel', kind: 'number', of: '', otherwise: '3' });
	expect(areParameters(CONTENT.parameters)).toBe(true);
	expect(areParameters(undefined)).toBe(true);
	expect(areParameters({ travel: { default: 3 } })).toBe(false);
	expect(areParameters(['travel'])).toBe(false);
	expect(rangesFor([NAMESPACE, LOADS], ['load'])).toEqual(['loads', 'load']);
});

test('a change is an edit of that parameter alone, and of as little of it as can be', () => {
	const edits = (parameter: Parameter) => parameterWritten(FILE, CONTENT, parameter);
	expect(edits(TRAVEL)).toEqual([]);
	expect(edits({ ...TRAVEL, otherwise: '4,5' })).toEqual([
		{ kind: 'set', file: FILE, path: ['parameters', 'travel', 'default'], was: 3, value: 4.5 }
	]);
	expect(edits({ ...TRAVEL, otherwise: '' })).toEqual([
		{ kind: 'remove', file: FILE, path: ['parameters', 'travel', 'default'], was: 3 }
	]);
	expect(edits({ ...NAMESPACE, kind: 'number' })).toEqual([
		{ kind: 'set', file: FILE, path: ['parameters', 'namespace'], was: 'text', value: 'number' }
	]);
	expect(edits({ ...NAMESPACE, otherwise: '3' })).toEqual([
		{ kind: 'set', file: FILE, path: ['parameters', 'namespace'], was: 'text', value: { kind: 'text', default: '3' } }
	]);
	expect(edits({ ...NOTHING, kind: 'resource' })).toEqual([
		{ kind: 'set', file: FILE, path: ['parameters', 'nothing', 'kind'], was: 'value', value: 'resource' },
		{ kind: 'remove', file: FILE, path: ['parameters', 'nothing', 'of'], was: 'loads' }
	]);
	expect(edits({ name: 'other', kind: 'resource', of: '', otherwise: '' })).toEqual([
		{ kind: 'add', file: FILE, path: ['parameters', 'other'], value: 'resource' }
	]);
	expect(parameterTaken(FILE, CONTENT, 'travel')).toEqual([
		{ kind: 'remove', file: FILE, path: ['parameters', 'travel'], was: { kind: 'number', default: 3 } }
	]);
	expect(parameterTaken(FILE, { parameters: { a: 'text' } }, 'a')).toMatchObject([{ kind: 'remove', path: ['parameters'] }]);
});

test('the default of a number is one', () => {
	expect([{ ...TRAVEL, otherwise: 'slow' }, { ...TRAVEL, otherwise: '' }, TRAVEL, { ...NAMESPACE, otherwise: 'slow' }].map(isDefault)).toEqual([
		false,
		true,
		true,
		true
	]);
});

test('what is shown of any parameter is what is written of it', () => {
	const name = fc.constantFrom('a', 'b_1');
	const parameter = fc.record({
		name,
		kind: fc.constantFrom('text', 'number', 'enumeration', 'value', 'resource'),
		of: fc.constant(''),
		otherwise: fc.constantFrom('', '3', 'some', '0.5')
	});
	fc.assert(
		fc.property(parameter, (one) => {
			fc.pre(isDefault(one));
			const given = one.kind === 'value' ? { ...one, of: 'loads' } : one;
			const [edit] = parameterWritten(FILE, {}, given);
			const value = edit?.kind === 'add' ? edit.value : null;
			const [shown] = parametersIn({ [one.name]: value as never });
			expect({ ...shown, otherwise: shown?.otherwise.replaceAll("'", '') }).toEqual(given);
		})
	);
});
