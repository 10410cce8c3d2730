/** The marks of the pages, in the rail and the palette. */
import Archive from '@lucide/svelte/icons/archive';
import Bell from '@lucide/svelte/icons/bell';
import BookText from '@lucide/svelte/icons/book-text';
import Box from '@lucide/svelte/icons/box';
import ClipboardList from '@lucide/svelte/icons/clipboard-list';
import Database from '@lucide/svelte/icons/database';
import FlaskConical from '@lucide/svelte/icons/flask-conical';
import Footprints from '@lucide/svelte/icons/footprints';
import GitPullRequestArrow from '@lucide/svelte/icons/git-pull-request-arrow';
import History from '@lucide/svelte/icons/history';
import KeyRound from '@lucide/svelte/icons/key-round';
import LayoutDashboard from '@lucide/svelte/icons/layout-dashboard';
import Monitor from '@lucide/svelte/icons/monitor';
import Network from '@lucide/svelte/icons/network';
import RotateCcw from '@lucide/svelte/icons/rotate-ccw';
import Table from '@lucide/svelte/icons/table-2';
import User from '@lucide/svelte/icons/user';
import Users from '@lucide/svelte/icons/users';
import Watch from '@lucide/svelte/icons/watch';
import Webhook from '@lucide/svelte/icons/webhook';
import Waypoints from '@lucide/svelte/icons/waypoints';
import Workflow from '@lucide/svelte/icons/workflow';
import type { Page } from '#lib/account/pages.ts';

export const MARKS = {
	operate: LayoutDashboard,
	restart: RotateCcw,
	state: Table,
	alarms: Bell,
	history: History,
	orders: ClipboardList,
	wall: Monitor,
	model: Box,
	operations: Waypoints,
	pipelines: Workflow,
	ros: Network,
	whatIf: FlaskConical,
	review: GitPullRequestArrow,
	begin: Footprints,
	journal: BookText,
	watches: Watch,
	people: Users,
	keys: KeyRound,
	webhooks: Webhook,
	backups: Archive,
	storage: Database,
	account: User,
	watch: Watch
} satisfies Readonly<Record<Page['title'], typeof Box>>;
