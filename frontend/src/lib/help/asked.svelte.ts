/** Whether somebody wants to know what one does on the page in sight. */
class Asked {
	open = $state(false);
}

export const asked = new Asked();
