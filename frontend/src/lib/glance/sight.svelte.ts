/** Whether the next start is in sight in large letters, so that nothing else need repeat it. */
class Sight {
	/** As the page lies now. */
	next = $state(false);

	/** Watches where it is said in large letters: an attachment. */
	watch = (element: HTMLElement): (() => void) => {
		const observer = new IntersectionObserver(([entry]) => (this.next = entry?.isIntersecting ?? false), {
			rootMargin: '-120px 0px 0px',
			threshold: 0.5
		});
		observer.observe(element);
		return () => {
			observer.disconnect();
			this.next = false;
		};
	};
}

export const sight = new Sight();
