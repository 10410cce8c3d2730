import type { Helped } from '#lib/help/helped.ts';

/** What one does on each page. Read when somebody asks for it. */
export const help: Helped = {
	title: (page: string): string => `${page}: what you do here`,
	keys: {
		title: 'Keys',
		all: [
			['Ctrl K', 'Search or act'],
			['?', 'This help'],
			['Tab, Shift Tab', 'To the next part of the page, or the one before'],
			['Arrow keys', 'Move within a list, the plan, the time line or a picture'],
			['F8', 'Go to the message about what you just did, to take it back'],
			['Escape', 'Close a dialog or a menu']
		],
		conditions: [
			['Ctrl Space', 'In a condition: what could stand there'],
			['F12, Shift F12', 'In a condition: to where a name is declared, and where it is used']
		]
	},
	pages: {
		operate: {
			about: 'The station as it is now: what it does, what comes next and what it asks of you.',
			how: [
				'The picture shows every device and the product. Press anything in it for its values and why it waits.',
				'The plan shows what runs, what comes next, and what waits for what.',
				'Your task: do it, then press Done. If it cannot be done, press Problem: somebody comes.',
				'Operations: what is done, what runs, and what the others wait for. Why? says more.',
				'Pause: running steps finish, nothing new starts. Hold: what can stop stops. Neither is an emergency stop.'
			]
		},
		restart: {
			about: 'Four steps lead a station that has stopped back to production. Each button says all that it does, and each act is recorded.',
			how: [
				'Understand: read what happened and what still moves.',
				'Make the state true: look at the station, and answer only what you have seen.',
				'Choose a way back: read what would move and what you would do, then take it.',
				'Go on: start production again.',
				'The step that is next opens by itself. Press another to look at it.'
			]
		},
		state: {
			about: 'Every variable of the station, as it is now. What is estimated can be corrected.',
			how: [
				'Search for a name or a value, or show only one resource or one kind.',
				'Press a variable for what it was, who wrote it and what waits for it.',
				'An estimate is wrong? Correct it. You see what follows before anything changes, and nothing starts by it.',
				'Tick several to correct or confirm them together. Confirm only what you have seen.'
			]
		},
		alarms: {
			about: 'What needs a person: what is wrong, what follows from it, and what to do.',
			how: [
				'The most urgent is on top: octagon for high, triangle for medium, diamond for low.',
				'Choose one to read what failed, what it means and what to do.',
				'Acknowledge says that you have seen it. It does not mend the cause.',
				'Shelve what cannot be mended now: it is silent for that long, and comes back.',
				'Set aside and Earlier show the others, and the figures how many came.'
			]
		},
		history: {
			about: 'What happened at the station, and what people did. Any moment can be looked at again; nothing of it can be changed.',
			how: [
				'Press the time line to choose a moment. Drag moves it, Ctrl with the wheel zooms; arrow keys go record by record.',
				'Play lets the time run from there, as fast as you choose.',
				'Below you see the station and its plan as they were at that moment.',
				'What differs from now stands beside it. From there you can also try how the work would go on.',
				'The events say who did what. Press one to go to its moment.',
				'Export saves records with the proof that nobody changed them.'
			]
		},
		orders: {
			about: 'What the station makes, in which order, and whether it is made in time.',
			how: [
				'From left to right: not released, waiting, in work, made today.',
				'Press an order for all about it, and for what can be done with it.',
				'Release an order so that it may start. A higher priority comes first.',
				'Make a new one with New order. It can also come from another system.',
				'By order, the station makes only what is ordered. Freely, it works whenever it can.'
			]
		},
		wall: {
			about: 'The station on a large screen that nobody touches, readable from five metres.',
			how: [
				'On top: the mode, the alarms and the time.',
				'The picture and the figures: how far the product and the day are.',
				'Below: what is asked of a person now, or what runs and what comes next.',
				'Full screen shows nothing else. The screen stays awake.'
			]
		},
		model: {
			about: 'The draft of the station’s model, which all engineers share. The station that runs is not touched by it.',
			how: [
				'Choose a part in the tree, or search for its name.',
				'Change it in its fields or as text. Both are the same, and everyone sees it at once.',
				'Problems stand below, each with its place: press that to go there. Some play the run that leads to them, step by step.',
				'Undo takes back what you have changed. When all is right, go on to Review changes.',
				'The draft is checked by itself whenever it changes; errors keep it from being used.',
				'An ability shows how it stands in the station that runs, and what it waits for. Try it alone among the runs: the station must be paused.',
				'Beside the problems are the usages of the chosen part, the guards that the supervisor adds, and runs. Shift and F12 lead to the usages.',
				'Graph shows the model in four layers, and what is tied to what. Open leads from there to the form.',
				'Examples… has stations to look at, to copy parts from, and to begin with.'
			]
		},
		operations: {
			about: 'What is to be done and in which order, as the draft of the model says it, with how far the station is.',
			how: [
				'Each resource has a lane; an arrow leads to what comes after. Solid: surely. Dashed: one of several will do.',
				'Choose an operation to see what it begins with and ends with, in words and as it is now. By keyboard: arrow keys lead from one to the next, Home and End to the first and the last, Enter to what is said of it, Escape back.',
				'Draw an arrow from the dot at the right of one to another to put it behind. It goes into the draft; what runs is not touched. Shift and a press, or Shift and Space, picks several to put together: in sequence, at once, in any order, or one of them.',
				'See the same over time, or as a table.'
			]
		},
		pipelines: {
			about: 'From messages to variables and back, as the draft of the model has it, with what passes there in the station that runs.',
			how: [
				'Choose a pipeline from the list: what its resource says stands above, what it is told below.',
				'Choose a box or a wire to edit it. Changes go into the draft; what runs is not touched.',
				'Drag a stage onto a wire, or a stage of the picture onto another one. Drag a box elsewhere, and it stays there for you.',
				'Ctrl C, Ctrl X and Ctrl V copy, cut and paste the chosen stage as YAML, also to another pipeline or an editor. Delete removes it.',
				'Try it with a message, and keep that as an example that must hold.'
			]
		},
		ros: {
			about: 'Who and what is on the ROS network, and how the station stands to it: for those who look for a topic that is silent.',
			how: [
				'What is wrong stands on top, with what to do.',
				'Choose a topic for its publishers, subscribers, settings and last message.',
				'See fewer by words, resource or state.'
			]
		},
		whatIf: {
			about: 'How the station would go on with the model as it is edited: simulated, with emulated devices and people who do what they are asked. The station is not touched by it.',
			how: [
				'Choose where it begins: now, or at a record of the history.',
				'Take what shall happen next: by a device, a person, a fault or a start. Arrow keys lead back and on.',
				'Go on otherwise from any step: that is a branch of its own.',
				'Follow the plan, or run until a condition holds.',
				'Or try it in simulated time: let the clock run, give a device a fault, go back to a moment and on otherwise.',
				'Or see the whole state space: choose variables to fold it by, and what is forbidden or not safe stands out. The picture begins where the station is; the last button above it shows all of it.',
				'The address keeps which of the three is shown.'
			]
		},
		begin: {
			about: 'A first station of few answers, which become plain documents that you can change like any others.',
			how: [
				'Six steps, in any order. A triangle marks a step in which something is still to put right.',
				'Answer what is asked. A name follows from its title until you write one.',
				'Read the document that is being made, as you write.',
				'Go on to the next step. The last one puts all of it into the draft, as one change.',
				'Leave whenever you like: what you wrote is kept in this browser.'
			]
		},
		review: {
			about: 'What will be different with the draft of the model, proven, and how it comes to the station.',
			how: [
				'Read what will be different: each change in a sentence, with what follows from it. Files show every line.',
				'The plan of the station as it stands now, with the model that runs and with the draft.',
				'Checks: what was looked for, how long it took, and what was found.',
				'Where two people are needed, an engineer who did not save the revision approves it or asks for changes, below Talk. Until then all who may are told, here and on Operate.',
				'Bring it to the station: do what is still missing in the list, then deploy.',
				'Revisions: see what differs, or go back to one. You read what that undoes first.'
			]
		},
		journal: {
			about: 'Everything that was done or refused. It can be read here and changed by nobody.',
			how: [
				'Each record says who did what, when, on what and from where. The newest is on top.',
				'Choose an act or a person above the list to see fewer.',
				'Open a record for its details, and from there the station as it was then.'
			]
		},
		watches: {
			about: 'A wearable, such as a watch, shows the tasks of one resource and says when they are done, without anybody signed in on it.',
			how: [
				'Choose whose tasks it shows, and get a code. The code works once, for two minutes.',
				'Open the operator view on the device and type the code in.',
				'Look at the device, then confirm here that it is the one you meant.',
				'Revoke a device that is lost: within two seconds it shows nothing.'
			]
		},
		people: {
			about: 'Each role may also do what those before it may: viewer, operator, engineer, administrator.',
			how: [
				'Add a person with a role. Hand the temporary password over yourself: it is shown once.',
				'Change a role, or take somebody’s access away: they are signed out everywhere.',
				'A forgotten password: give a new temporary one.'
			]
		},
		keys: {
			about: 'With a key another system reads the station over its interface, or gives orders. Whether the station works on those is for people to say.',
			how: [
				'Make a key for each system of its own, with no more rights than it needs.',
				'Keep its secret at once: it is shown once.',
				'Before a key expires give it a new secret; the old one works on for the time you choose.'
			]
		},
		webhooks: {
			about: 'A webhook tells another system of each event of orders and of the station: at least once, signed, and only where the list on this page allows it.',
			how: [
				'Make one with the address that events are sent to. It must be allowed by the list on this page.',
				'Keep its secret at once: with it the other system knows that a message comes from here.',
				'What was given up can be sent again.'
			]
		},
		backups: {
			about: 'A backup has the database, the revisions and the model of the station as they were at one moment, in one file on the machine of the station.',
			how: [
				'See whether the newest backup is recent and whole.',
				'Make one before you change anything large; check one to know that it can be read.',
				'Copy the files to another machine: if this disk fails, backups on it are lost too.',
				'A backup is restored at the command line; the page says how.'
			]
		},
		storage: {
			about: 'What happened, and job orders that are over, leave the database for the archive after a while. History and replay read both.',
			how: [
				'See how large the records are, how fast they grow, and when the disk would be full.',
				'Archive now, if you do not want to wait.',
				'How long records are kept is an option of the start; the page names it.'
			]
		},
		account: {
			about: 'Who is signed in here, and what that role may do.',
			how: [
				'See your role. An administrator can change it.',
				'Change your password. All your other sessions end.',
				'Sign out, above all on a screen that others use too.'
			]
		}
	}
};
