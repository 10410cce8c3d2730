/** How what is on the network is said. */
import type { Endpoint, Quality } from '#lib/contract.ts';
import type { Text } from '#lib/text/text.svelte.ts';

/** A span in seconds: `0.4 s`, `12 s`, `3 min`, `2 h`. */
export function spanText(seconds: number, { locale, ros }: Text): string {
	const span = Math.max(0, seconds);
	if (span < 10) return `${span.toLocaleString(locale, { maximumFractionDigits: 1 })} s`;
	if (span < 120) return `${Math.floor(span)} s`;
	if (span < 7200) return `${Math.floor(span / 60)} min`;
	if (span < 172800) return `${Math.floor(span / 3600)} h`;
	return ros.days(Math.floor(span / 86400));
}

/** A quality of service in words. */
export function qualityText(quality: Quality, texts: Text): string {
	const words = texts.ros.quality;
	return [
		words[quality.reliability],
		words[quality.durability],
		...(quality.deadline === null ? [] : [words.deadline(spanText(quality.deadline, texts))]),
		...(quality.liveliness === null ? [] : [words.liveliness(spanText(quality.liveliness, texts))])
	].join(', ');
}

/** Whose endpoint it is; the station's own is told as such. */
export function endText({ node, own }: Pick<Endpoint, 'node' | 'own'>, { ros }: Text): string {
	if (own) return node === null ? ros.station : ros.you(node);
	return node ?? ros.unnamed;
}

/** Nodes one after the other. */
export function nodesText(nodes: readonly (string | null)[], { ros }: Text): string {
	return nodes.length === 0 ? ros.nobody : nodes.map((node) => node ?? ros.unnamed).join(', ');
}
