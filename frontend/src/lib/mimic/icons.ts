/** The symbols, drawn in 24 by 24. */
import type { MimicSymbol } from '#lib/contract.ts';

export const ICONS: Readonly<Record<MimicSymbol['symbol'], string>> = {
	arm: 'M4 21h9M6 21v-3.2a2.5 2.5 0 0 1 5 0V21M5 9.5a2 2 0 1 0 4 0a2 2 0 1 0-4 0M7.9 11.3l1 4M8.6 8.3l6.2-4M14.8 4.2a1.7 1.7 0 1 0 3.4 0a1.7 1.7 0 1 0-3.4 0M17.4 5.8L19 9M16.6 12.4v-1.8L19 9l2.4 1v2',
	gripper: 'M12 2v5M6 7h12v4H6zM8 11v4l-2 2v4M16 11v4l2 2v4',
	tool: 'M10 18a1 1 0 0 1 1 1v2a1 1 0 0 1-1 1H5a3 3 0 0 1-3-3a1 1 0 0 1 1-1zM13 10H4a2 2 0 0 1-2-2V4a2 2 0 0 1 2-2h9a1 1 0 0 1 1 1v6a1 1 0 0 1-1 1l-.81 3.24a1 1 0 0 1-.97.76H8M14 4h3a1 1 0 0 1 1 1v2a1 1 0 0 1-1 1h-3M18 6h4M5 10l-2 8M7 18l2-8',
	dock: 'M3 20h18M5 20V9h5v11M14 20V9h5v11M7.5 9V5M16.5 9V5M5 5h14',
	agv: 'M4 9h16a2 2 0 0 1 2 2v3a2 2 0 0 1-2 2H4a2 2 0 0 1-2-2v-3a2 2 0 0 1 2-2zM5.2 17.5a1.8 1.8 0 1 0 3.6 0M15.2 17.5a1.8 1.8 0 1 0 3.6 0M5 9V6h14v3M9 6v3M14 6v3',
	conveyor: 'M5 13h14a3 3 0 0 1 0 6H5a3 3 0 0 1 0-6zM5 16h.01M12 16h.01M19 16h.01M7 5h10v8H7zM12 5v3',
	workpiece: 'M4 9h3V6h9v3h2l2 2.5V18h-3l-2 2H8l-2-2H4zM2 12v4M11.5 3v3M9 3h5',
	camera: 'M3 7V5a2 2 0 0 1 2-2h2M17 3h2a2 2 0 0 1 2 2v2M21 17v2a2 2 0 0 1-2 2h-2M7 21H5a2 2 0 0 1-2-2v-2M8 12a4 4 0 1 0 8 0a4 4 0 1 0-8 0',
	person: 'M19 21v-2a4 4 0 0 0-4-4H9a4 4 0 0 0-4 4v2M8 7a4 4 0 1 0 8 0a4 4 0 1 0-8 0',
	light: 'M9 3h6v14H9zM9 7.7h6M9 12.3h6M12 17v4M8 21h8',
	door: 'M5 21V4a1 1 0 0 1 1-1h12a1 1 0 0 1 1 1v17M3 21h18M15 12v1',
	tank: 'M5 6v12c0 1.7 3.1 3 7 3s7-1.3 7-3V6M5 6a7 3 0 1 0 14 0a7 3 0 1 0-14 0M5 12c0 1.7 3.1 3 7 3s7-1.3 7-3',
	device: 'M21 8a2 2 0 0 0-1-1.73l-7-4a2 2 0 0 0-2 0l-7 4A2 2 0 0 0 3 8v8a2 2 0 0 0 1 1.73l7 4a2 2 0 0 0 2 0l7-4A2 2 0 0 0 21 16ZM3.3 7L12 12l8.7-5M12 22V12'
};
