import type { Text } from '../text.svelte.ts';
import { count } from '../count.ts';

export const examples: Text['examples'] = {
	title: 'Exempelstationer',
	open: 'Exempel…',
	about: 'Se hur andra är byggda. Där kan inget ändras, men delar kan kopieras, och din egen station kan börja med en av dem.',
	first: 'Börja med ett exempel',
	firstAbout: 'Ett tryck öppnar det så att du kan se på det. Ditt utkast är som det är tills du börjar med ett.',
	loading: 'Exemplen läses.',
	none: 'Det finns inga exempelstationer',
	noneHow: 'Sequence Planner installerades utan dem. De finns i mappen models i dess kodförråd.',
	sizes: (resources, abilities, operations) =>
		[count(resources, 'resurs', 'resurser'), count(abilities, 'förmåga', 'förmågor'), count(operations, 'operation', 'operationer')].join(', '),
	shows: {
		bolt_tightening: 'Visar en person och en robot som turas om, en förmåga för vart och ett av flera skruvpar, och en arbetsmall.',
		docking_agv: 'Visar ett batteri som aldrig får ta slut på vägen, dess docka, och en person som tar av satser.',
		robots_with_buffer: 'Visar två robotar av en typ, en zon som de delar, och ett larm för stationen.',
		single_bolt: 'Visar den minsta station som gör något. Den byggs i guiden till en första station.',
		truck_engine_station: 'Visar en hel station: verktyg, en AGV, instruktioner med bilder, en bild av stationen, skift, och vad man gör när roboten är död.'
	},
	isShown: (title) => `Du ser på exempelstationen ”${title}”. Den kan inte ändras här.`,
	begin: 'Börja med den',
	back: 'Tillbaka till din station',
	begun: (title) => `Började med ”${title}”`,
	replace: {
		title: (title) => `Börja med ”${title}”?`,
		about: (files) => `Den tar platsen för allt som finns i ditt utkast: ${count(files, 'fil', 'filer')}.`,
		more: (files, others) => `${files.join(', ')}${others > 0 ? ` och ${others} till` : ''}`,
		stays: 'Din stations namn blir kvar, och det som körs går vidare som det är. Du kan ångra det.'
	}
};
