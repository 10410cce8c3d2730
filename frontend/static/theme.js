/* Applies the theme that was chosen in this browser before anything is painted (see src/lib/theme/theme.ts). */
(function () {
	var theme = 'auto';
	try {
		theme = localStorage.getItem('theme') || 'auto';
	} catch (error) {
		/* storage is forbidden: follow the device */
	}
	document.documentElement.dataset.theme = theme;
})();
