import type { Helped } from '#lib/help/helped.ts';

export const help: Helped = {
	title: (page) => `${page}: vad du gör här`,
	keys: {
		title: 'Tangenter',
		all: [
			['Ctrl K', 'Sök eller agera'],
			['?', 'Den här hjälpen'],
			['Tab, Skift Tab', 'Till sidans nästa del, eller den förra'],
			['Piltangenter', 'Flytta inom en lista, planen, tidslinjen eller en bild'],
			['F8', 'Gå till meddelandet om det du just gjorde, för att ta tillbaka det'],
			['Escape', 'Stäng en dialog eller en meny']
		],
		conditions: [
			['Ctrl Mellanslag', 'I ett villkor: vad som kan stå där'],
			['F12, Skift F12', 'I ett villkor: dit ett namn deklareras, och var det används']
		]
	},
	pages: {
		operate: {
			about: 'Stationen som den är nu: vad den gör, vad som kommer sedan och vad den ber dig om.',
			how: [
				'Bilden visar varje enhet och produkten. Tryck på något i den för att se dess värden och varför det väntar.',
				'Planen visar vad som pågår, vad som kommer sedan och vad som väntar på vad.',
				'Din uppgift: gör den och tryck sedan på Klart. Går det inte, tryck på Problem: någon kommer.',
				'Operationer: vad som är klart, vad som pågår och vad de andra väntar på. Varför? säger mer.',
				'Pausa: pågående steg görs klara, inget nytt startar. Stoppa: det som kan stoppas stannar. Ingen av dem är ett nödstopp.'
			]
		},
		restart: {
			about: 'Fyra steg leder en station som har stannat tillbaka till produktion. Varje knapp säger allt som den gör, och varje åtgärd loggas.',
			how: [
				'Förstå: läs vad som hänt och vad som ännu rör sig.',
				'Gör tillståndet sant: titta på stationen och svara bara på det du har sett.',
				'Välj en väg tillbaka: läs vad som skulle röra sig och vad du själv gör, och ta den sedan.',
				'Fortsätt: starta produktionen igen.',
				'Steget som står på tur öppnas av sig självt. Tryck på ett annat för att se det.'
			]
		},
		state: {
			about: 'Stationens alla variabler, som de är nu. Det som är uppskattat kan rättas.',
			how: [
				'Sök efter ett namn eller ett värde, eller visa bara en resurs eller en sort.',
				'Tryck på en variabel för att se vad den har varit, vem som skrev den och vad som väntar på den.',
				'Är en uppskattning fel? Rätta den. Du ser vad som följer innan något ändras, och inget startar av det.',
				'Kryssa för flera för att rätta eller bekräfta dem tillsammans. Bekräfta bara det du har sett.'
			]
		},
		alarms: {
			about: 'Det som behöver en människa: vad som är fel, vad det leder till och vad man gör åt det.',
			how: [
				'Det mest brådskande är överst: åttahörning för hög, triangel för medel, romb för låg.',
				'Välj ett för att läsa vad som är fel, vad det betyder och vad du gör.',
				'Kvittera säger att du har sett det. Det lagar inte orsaken.',
				'Lägg åt sidan det som inte kan lagas nu: det är tyst så länge, och kommer tillbaka.',
				'De andra finns under Åt sidan och Tidigare, och siffrorna visar hur många som kom.'
			]
		},
		history: {
			about: 'Vad som hänt på stationen och vad människor gjort. Varje ögonblick kan ses på nytt; inget av det kan ändras.',
			how: [
				'Tryck på tidslinjen för att välja ett ögonblick. Dra för att flytta den, Ctrl med hjulet zoomar; piltangenterna går post för post.',
				'Spela låter tiden gå därifrån, så fort som du väljer.',
				'Nedanför ser du stationen och dess plan som de var då.',
				'Bredvid står vad som skiljer sig från nu. Därifrån kan du också pröva hur arbetet skulle gå vidare.',
				'Händelserna säger vem som gjorde vad. Tryck på en för att gå till dess ögonblick.',
				'Exportera sparar poster med bevis för att ingen har ändrat dem.'
			]
		},
		orders: {
			about: 'Vad stationen tillverkar, i vilken ordning, och om det blir klart i tid.',
			how: [
				'Från vänster till höger: inte släppta, väntar, i arbete, tillverkat i dag.',
				'Tryck på en order för allt om den, och för vad som kan göras med den.',
				'Släpp en order så att den får börja. Högre prioritet kommer först.',
				'Gör en ny med Ny order. Den kan också komma från ett annat system.',
				'På order gör stationen bara det som är beställt. Fritt arbetar den när den kan.'
			]
		},
		wall: {
			about: 'Stationen på en stor skärm som ingen rör, läsbar på fem meters håll.',
			how: [
				'Överst: läget, larmen och klockan.',
				'Bilden och siffrorna: hur långt produkten och dagen har kommit.',
				'Nederst: vad som begärs av en människa nu, eller vad som pågår och vad som kommer sedan.',
				'Helskärm visar inget annat. Skärmen hålls vaken.'
			]
		},
		model: {
			about: 'Utkastet till stationens modell, som alla ingenjörer delar. Stationen som är i drift påverkas inte.',
			how: [
				'Välj en del i trädet, eller sök efter dess namn.',
				'Ändra den i dess fält eller som text. Båda är samma sak, och alla ser det genast.',
				'Problem står nedanför, vart och ett med sin plats: tryck på den för att komma dit. Några spelar upp det som leder till dem, steg för steg.',
				'Ångra tar tillbaka det du har ändrat. När allt stämmer: gå vidare till Granska ändringar.',
				'Utkastet kontrolleras av sig självt så fort det ändras; fel gör att det inte kan användas.',
				'En förmåga visar hur den står i stationen som kör, och vad den väntar på. Prova den ensam bland körningarna: stationen måste vara pausad.',
				'Bredvid problemen finns var den valda delen används, villkoren som övervakaren lägger till, och körningar. Skift och F12 leder till användningarna.',
				'Graf visar modellen i fyra lager, och vad som hör ihop med vad. Öppna leder därifrån till formuläret.',
				'Exempel… har stationer att se på, att kopiera delar från och att börja med.'
			]
		},
		operations: {
			about: 'Vad som ska göras och i vilken ordning, som utkastet till modellen säger, och hur långt stationen har kommit.',
			how: [
				'Varje resurs har en bana; en pil leder till det som kommer efter. Heldragen: säkert. Streckad: en av flera räcker.',
				'Välj en operation för att se vad den börjar med och slutar med, i ord och som det är nu. Med tangentbordet: piltangenterna leder från en till nästa, Home och End till den första och den sista, Enter till det som sägs om den, Escape tillbaka.',
				'Dra en pil från punkten till höger om en operation till en annan för att lägga den efter. Det hamnar i utkastet; det som kör påverkas inte. Skift och ett tryck, eller Skift och mellanslag, väljer ut flera att lägga ihop: i följd, samtidigt, i valfri ordning eller en av dem.',
				'Se samma sak över tid eller som tabell.'
			]
		},
		pipelines: {
			about: 'Från meddelanden till variabler och tillbaka, så som modellens utkast har det, med det som passerar i stationen som kör.',
			how: [
				'Välj en pipeline i listan: vad resursen säger står ovanför, vad den får höra nedanför.',
				'Välj en ruta eller en ledning för att ändra den. Ändringar hamnar i utkastet; det som körs rörs inte.',
				'Dra ett steg till en ledning, eller ett steg i bilden till en annan. Dra en ruta någon annanstans, så stannar den där för dig.',
				'Ctrl C, Ctrl X och Ctrl V kopierar, klipper ut och klistrar in det valda steget som YAML, även till en annan pipeline eller en editor. Delete tar bort det.',
				'Prova med ett meddelande, och spara det som ett exempel som måste stämma.'
			]
		},
		ros: {
			about: 'Vem och vad som finns på ROS-nätet, och hur stationen förhåller sig till det: för den som letar efter en topic som är tyst.',
			how: [
				'Överst står vad som är fel och vad du kan göra.',
				'Välj en topic för avsändare, mottagare, inställningar och senaste meddelande.',
				'Visa färre med ord, resurs eller tillstånd.'
			]
		},
		whatIf: {
			about: 'Hur stationen skulle fortsätta med modellen som den redigeras: simulerat, med emulerade enheter och personer som gör det de ombeds. Stationen påverkas inte.',
			how: [
				'Välj var det börjar: nu, eller vid en post i historiken.',
				'Ta det som ska hända härnäst: av en enhet, en person, ett fel eller en start. Piltangenterna leder bakåt och framåt.',
				'Gå vidare på annat sätt från vilket steg som helst: det blir en egen gren.',
				'Följ planen, eller kör tills ett villkor gäller.',
				'Eller prova i simulerad tid: låt klockan gå, ge en enhet ett fel, gå tillbaka till ett ögonblick och vidare på annat sätt.',
				'Eller se hela tillståndsrummet: välj variabler att dela in det efter, så syns vad som är förbjudet eller inte säkert. Bilden börjar där stationen är; den sista knappen ovanför visar alltihop.',
				'Adressen kommer ihåg vilken av de tre som visas.'
			]
		},
		begin: {
			about: 'En första station av några svar, som blir vanliga dokument som du kan ändra som alla andra.',
			how: [
				'Sex steg, i valfri ordning. En triangel märker ett steg där något är kvar att rätta.',
				'Svara på det som frågas. Ett namn följer av titeln tills du skriver ett.',
				'Läs dokumentet som görs, medan du skriver.',
				'Gå vidare till nästa steg. Det sista lägger allt i utkastet, som en ändring.',
				'Gå när du vill: det du har skrivit behålls i den här webbläsaren.'
			]
		},
		review: {
			about: 'Vad som blir annorlunda med utkastet av modellen, bevisat, och hur det kommer till stationen.',
			how: [
				'Läs vad som blir annorlunda: varje ändring i en mening, med det som följer av den. Filer visar varje rad.',
				'Planen för stationen som den står nu, med modellen som körs och med utkastet.',
				'Kontroller: vad som söktes, hur lång tid det tog och vad som hittades.',
				'Där två personer behövs: någon annan än den som sparade revisionen godkänner den, eller ber om ändringar, under Samtal. Till dess får alla som kan göra det veta det, här och på Drift.',
				'För det till stationen: gör det som saknas i listan, driftsätt sedan.',
				'Revisioner: se vad som skiljer, eller gå tillbaka till en. Du läser först vad det ångrar.'
			]
		},
		journal: {
			about: 'Allt som gjordes eller nekades. Det kan läsas här och ändras av ingen.',
			how: [
				'Varje post säger vem som gjorde vad, när, med vad och varifrån. Den nyaste är överst.',
				'Välj en handling eller en person ovanför listan för att se färre.',
				'Öppna en post för detaljerna, och därifrån stationen som den var då.'
			]
		},
		watches: {
			about: 'En bärbar enhet, som en klocka, visar en resurs uppgifter och säger till när de är klara, utan att någon är inloggad på den.',
			how: [
				'Välj vems uppgifter den visar och hämta en kod. Koden fungerar en gång, i två minuter.',
				'Öppna operatörsvyn på enheten och skriv in koden.',
				'Se på enheten och bekräfta sedan här att det är rätt.',
				'Återkalla en enhet som är borta: inom två sekunder visar den inget.'
			]
		},
		people: {
			about: 'Varje roll får också göra det som rollerna före den får: betraktare, operatör, ingenjör, administratör.',
			how: [
				'Lägg till en person med en roll. Lämna över det tillfälliga lösenordet själv: det visas en gång.',
				'Ändra en roll eller stäng av någon: personen loggas ut överallt.',
				'Glömt lösenord: ge ett nytt tillfälligt.'
			]
		},
		keys: {
			about: 'Med en nyckel läser ett annat system stationen genom dess gränssnitt, eller lägger order. Om stationen arbetar på dem avgör människor.',
			how: [
				'Gör en nyckel för varje system, med inte fler rättigheter än det behöver.',
				'Spara hemligheten genast: den visas en gång.',
				'Ge nyckeln en ny hemlighet innan den går ut; den gamla fungerar så länge du väljer.'
			]
		},
		webhooks: {
			about: 'En webhook berättar för ett annat system om varje händelse med order och med stationen: minst en gång, signerat och bara dit listan på sidan tillåter.',
			how: [
				'Gör en med adressen dit händelser skickas. Den måste vara tillåten enligt listan på sidan.',
				'Spara hemligheten genast: med den vet det andra systemet att ett meddelande kommer härifrån.',
				'Det som gavs upp kan skickas igen.'
			]
		},
		backups: {
			about: 'En säkerhetskopia har stationens databas, revisioner och modell som de var i ett ögonblick, i en fil på stationens maskin.',
			how: [
				'Se om den nyaste säkerhetskopian är färsk och hel.',
				'Gör en innan du ändrar något stort; kontrollera en för att veta att den kan läsas.',
				'Kopiera filerna till en annan maskin: går disken sönder är kopiorna på den också borta.',
				'En kopia återställs på kommandoraden; sidan säger hur.'
			]
		},
		storage: {
			about: 'Vad som hänt, och avslutade order, flyttas efter en tid från databasen till arkivet. Historik och återspelning läser båda.',
			how: [
				'Se hur stora posterna är, hur fort de växer och när disken blir full.',
				'Arkivera nu, om du inte vill vänta.',
				'Hur länge poster sparas väljs vid starten; sidan nämner hur.'
			]
		},
		account: {
			about: 'Vem som är inloggad här, och vad den rollen får göra.',
			how: [
				'Se din roll. En administratör kan ändra den.',
				'Byt lösenord. Alla dina andra sessioner avslutas.',
				'Logga ut, framför allt på en skärm som andra också använder.'
			]
		}
	}
};
