/**
 * A provider of OpenID Connect on this machine, for tests: `oidc-provider`, which is certified, with the people of a test.
 *
 * The first line of standard input is how it is to be (`Setup` below); `ready` on standard output says that it answers. A
 * further line `{"people": …}` changes who there is; `{"forge": …}` lets the next ID tokens be others than it has made, as
 * those of an attacker are who has a provider's key; null ends that. It ends with its input.
 *
 * Setup: `port`; `client`, `secret` and `station` (the addresses of stations); `people` by what they type at the sign-in,
 * each with the claims about them; `key`, the name of the key that it signs with.
 */
import { createHmac, createPrivateKey, generateKeyPairSync, sign } from 'node:crypto';
import { createInterface } from 'node:readline';
import Provider from 'oidc-provider';

const lines = createInterface({ input: process.stdin })[Symbol.asyncIterator]();
const setup = JSON.parse((await lines.next()).value);
const issuer = `http://127.0.0.1:${setup.port}`;
const key = {
	...generateKeyPairSync('rsa', { modulusLength: 2048 }).privateKey.export({ format: 'jwk' }),
	kid: setup.key,
	alg: 'RS256',
	use: 'sig'
};
let { people } = setup;
let forge = null;

const provider = new Provider(issuer, {
	clients: [
		{
			client_id: setup.client,
			client_secret: setup.secret,
			redirect_uris: setup.station.map((address) => `${address}/sign-in/provider`),
			post_logout_redirect_uris: setup.station.map((address) => `${address}/sign-in`)
		}
	],
	claims: { openid: ['sub'], profile: ['name', 'preferred_username', 'groups'] },
	cookies: { keys: ['of a test alone'] },
	features: { devInteractions: { enabled: true }, rpInitiatedLogout: { enabled: true } },
	findAccount: (_, id) => (id in people ? { accountId: id, claims: () => ({ ...people[id], sub: id }) } : undefined),
	jwks: { keys: [key] },
	/** Nobody is asked whether the station may know who they are: it belongs to the same firm. */
	async loadExistingGrant({ oidc }) {
		const grant = new oidc.provider.Grant({ clientId: oidc.client.clientId, accountId: oidc.session.accountId });
		grant.addOIDCScope('openid profile');
		await grant.save();
		return grant;
	},
	ttl: { AccessToken: 600, AuthorizationCode: 60, Grant: 600, IdToken: 600, Interaction: 600, Session: 600 }
});

provider.use(async (context, next) => {
	await next();
	if (forge && context.path === '/token' && context.body?.id_token)
		context.body = { ...context.body, id_token: forged(context.body.id_token, forge) };
});

/** The token with other claims and another header, signed with the provider's own key or as `alg` says. */
function forged(token, { claims = {}, header = {}, without = [], secret = '', broken = false }) {
	const [before, said] = token.split('.', 2).map((part) => JSON.parse(Buffer.from(part, 'base64url').toString()));
	const now = { ...said, ...claims };
	for (const name of without) delete now[name];
	const head = { ...before, ...header };
	const text = [head, now].map((part) => Buffer.from(JSON.stringify(part)).toString('base64url')).join('.');
	const signatures = {
		none: () => Buffer.alloc(0),
		HS256: () => createHmac('sha256', secret).update(text).digest(),
		RS256: () => sign('sha256', text, createPrivateKey({ key, format: 'jwk' }))
	};
	const signature = signatures[head.alg]();
	if (broken) signature[0] ^= 1;
	return `${text}.${signature.toString('base64url')}`;
}

const server = provider.listen(setup.port, '127.0.0.1', () => console.log('ready'));
for await (const line of lines) {
	const change = JSON.parse(line);
	if ('people' in change) people = change.people;
	if ('forge' in change) forge = change.forge;
	console.log('changed');
}
server.closeAllConnections();
server.close();
