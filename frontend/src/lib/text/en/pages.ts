/** What the pages are called. */
export const pages = {
	operate: 'Operate',
	restart: 'Restart',
	state: 'State',
	alarms: 'Alarms',
	history: 'History',
	orders: 'Orders',
	model: 'Model',
	pipelines: 'Pipelines',
	ros: 'ROS',
	whatIf: 'What if',
	station: 'Station',
	check: 'Check',
	deploy: 'Deploy',
	ability: 'Ability',
	watch: 'Watch',
	account: 'Account',
	journal: 'Journal',
	watches: 'Watches',
	people: 'People',
	keys: 'Keys',
	webhooks: 'Webhooks'
};
