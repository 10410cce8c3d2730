/** Puts a text on the clipboard at the press of a button, also where the page has no leave to use it otherwise; whether it could. */
export function toClipboard(text: string): boolean {
	let taken = false;
	const put = (event: ClipboardEvent): void => {
		event.preventDefault();
		event.stopImmediatePropagation();
		event.clipboardData?.setData('text/plain', text);
		taken = event.clipboardData !== null;
	};
	document.addEventListener('copy', put, { capture: true, once: true });
	try {
		document.execCommand('copy');
	} finally {
		document.removeEventListener('copy', put, { capture: true });
	}
	return taken;
}
