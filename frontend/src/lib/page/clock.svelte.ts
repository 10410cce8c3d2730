/** This device's clock, for what is told as `5 min ago` or as time that is left. */
export class Clock {
	/** Seconds since the epoch, as of the last step. */
	now = $state(Date.now() / 1000);

	/** Steps once a second; the result ends that. */
	start(): () => void {
		const timer = setInterval(() => (this.now = Date.now() / 1000), 1000);
		return () => clearInterval(timer);
	}
}
