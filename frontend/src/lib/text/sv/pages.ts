import type { Text } from '../text.svelte.ts';

export const pages: Text['pages'] = {
	operate: 'Drift',
	restart: 'Omstart',
	state: 'Tillstånd',
	alarms: 'Larm',
	history: 'Historik',
	orders: 'Order',
	model: 'Modell',
	pipelines: 'Pipelines',
	ros: 'ROS',
	whatIf: 'Tänk om',
	station: 'Stationen',
	check: 'Granskning',
	deploy: 'Driftsättning',
	ability: 'Förmåga',
	watch: 'Klocka',
	account: 'Konto',
	journal: 'Journal',
	watches: 'Klockor',
	people: 'Personer',
	keys: 'Nycklar',
	webhooks: 'Webhooks',
	backups: 'Säkerhetskopior',
	storage: 'Lagring'
};
