import type { Text } from '../text.svelte.ts';

export const pages: Text['pages'] = {
	operate: 'Drift',
	restart: 'Omstart',
	state: 'Tillstånd',
	alarms: 'Larm',
	history: 'Historik',
	orders: 'Order',
	wall: 'Väggvy',
	model: 'Modell',
	operations: 'Operationer',
	pipelines: 'Pipelines',
	ros: 'ROS-nätverk',
	whatIf: 'Tänk om',
	review: 'Granska ändringar',
	begin: 'Första stationen',
	watch: 'Operatörsvy',
	account: 'Konto',
	journal: 'Journal',
	watches: 'Klockor',
	people: 'Användare',
	keys: 'API-nycklar',
	webhooks: 'Webhooks',
	backups: 'Säkerhetskopior',
	storage: 'Lagring'
};
