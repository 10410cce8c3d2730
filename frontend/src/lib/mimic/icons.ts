/** The symbols, drawn in 24 by 24. */
import type { MimicSymbol } from '#lib/contract.ts';

export const ICONS: Readonly<Record<MimicSymbol['symbol'], string>> = {
	arm: 'M4 21h9M6 21v-3.2a2.5 2.5 0 0 1 5 0V21M5 9.5a2 2 0 1 0 4 0a2 2 0 1 0-4 0M7.9 11.3l1 4M8.6 8.3l6.2-4M14.8 4.2a1.7 1.7 0 1 0 3.4 0a1.7 1.7 0 1 0-3.4 0M17.4 5.8L19 9M16.6 12.4v-1.8L19 9l2.4 1v2',
	gripper: 'M12 2v5M6 7h12v4H6zM8 11v4l-2 2v4M16 11v4l2 2v4',
	tool: 'M3 4h11l2 2v3l-2 2H3zM16 7.5h5M5 11l-1.5 6h6L11 11M3 20h8v-3H3zM6 4v7',
	dock: 'M3 20h18M5 20V9h5v11M14 20V9h5v11M7.5 9V5M16.5 9V5M5 5h14',
	agv: 'M4 9h16a2 2 0 0 1 2 2v3a2 2 0 0 1-2 2H4a2 2 0 0 1-2-2v-3a2 2 0 0 1 2-2zM5.2 17.5a1.8 1.8 0 1 0 3.6 0M15.2 17.5a1.8 1.8 0 1 0 3.6 0M5 9V6h14v3M9 6v3M14 6v3',
	conveyor: 'M5 13h14a3 3 0 0 1 0 6H5a3 3 0 0 1 0-6zM5 16h.01M12 16h.01M19 16h.01M7 5h10v8H7zM12 5v3',
	workpiece: 'M4 9h3V6h9v3h2l2 2.5V18h-3l-2 2H8l-2-2H4zM2 12v4M11.5 3v3M9 3h5',
	camera: 'M4 7h4l1.5-2.5h5L16 7h4v12H4zM8.5 13a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0-7 0M17.5 10h.01',
	person: 'M8.5 6.5a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0-7 0M4.5 21c0-5 3-8 7.5-8s7.5 3 7.5 8z',
	light: 'M9 3h6v14H9zM9 7.7h6M9 12.3h6M12 17v4M8 21h8',
	door: 'M5 21V4a1 1 0 0 1 1-1h12a1 1 0 0 1 1 1v17M3 21h18M15 12v1',
	tank: 'M5 6v12c0 1.7 3.1 3 7 3s7-1.3 7-3V6M5 6a7 3 0 1 0 14 0a7 3 0 1 0-14 0M5 12c0 1.7 3.1 3 7 3s7-1.3 7-3',
	device: 'M4 5h16v14H4zM4 10h16M8 7.5h.01M11 7.5h.01M8 14h8M8 16.5h5'
};
