/** What the documents of a model may hold. Made by `scripts/documents.ts` from `docs/schemas`: do not edit. */
import type { PartShape } from './shape.ts';

export const PARTS: Readonly<Record<string, PartShape>> = {
	"station": {
		"about": "The station as a whole: what is common to its resources. `rest` describes the states of rest.",
		"fields": {
			"name": {
				"kind": "text",
				"help": "The station's name.",
				"required": true
			},
			"title": {
				"kind": "text",
				"help": "For people.",
				"required": false
			},
			"description": {
				"kind": "text",
				"help": "For people.",
				"required": false
			},
			"enumerations": {
				"kind": "lists",
				"help": "Named values, in order.",
				"required": false
			},
			"estimated": {
				"kind": "parts",
				"part": "variable",
				"help": "Variables of the station as a whole, which abilities of every resource may write.",
				"required": false
			},
			"rest": {
				"kind": "predicate",
				"help": "The states to which the station can always be brought back.",
				"required": false,
				"otherwise": true
			},
			"takeover": {
				"kind": "choice",
				"choices": [
					"confirm",
					"automatic"
				],
				"help": "Where a hot standby has taken the command over: whether a person confirms that production goes on.",
				"required": false,
				"otherwise": "confirm"
			}
		}
	},
	"variable": {
		"about": "A variable: `type` is `bool`, an enumeration, or a range such as `0..3`. A measured or output variable without one has the type of the message field that it belongs to.",
		"fields": {
			"type": {
				"kind": "text",
				"help": "`bool`, an enumeration, or a range such as `0..3`. May be left out where a message field tells it.",
				"required": false
			},
			"initial": {
				"kind": "value",
				"help": "The first value; without it the first of the type.",
				"required": false
			},
			"for": {
				"kind": "names",
				"help": "One variable per value of an enumeration: `{where: side}` makes `name[left]` and `name[right]`.",
				"required": false
			},
			"approval": {
				"kind": "choice",
				"choices": [
					"single",
					"dual"
				],
				"help": "`dual`: each correction and force of it needs a second person (four-eyes principle).",
				"required": false,
				"otherwise": "single"
			}
		}
	},
	"resource": {
		"about": "A resource: its topics, its variables by who writes them, and what it can do.",
		"fields": {
			"title": {
				"kind": "text",
				"help": "For people.",
				"required": false
			},
			"topics": {
				"kind": "parts",
				"part": "topic",
				"help": "The ROS 2 topics that the resource is reached by.",
				"required": false
			},
			"flows": {
				"kind": "parts",
				"part": "flow",
				"help": "Records of several topics brought together, or of one topic a second time.",
				"required": false
			},
			"services": {
				"kind": "parts",
				"part": "service",
				"help": "The ROS 2 services of the device that the station calls.",
				"required": false
			},
			"actions": {
				"kind": "parts",
				"part": "action",
				"help": "The ROS 2 actions of the device that the station sends goals to.",
				"required": false
			},
			"measured": {
				"kind": "parts",
				"part": "variable",
				"help": "Variables written by incoming messages.",
				"required": false
			},
			"output": {
				"kind": "parts",
				"part": "variable",
				"help": "Variables written by abilities, which leave in outgoing messages.",
				"required": false
			},
			"estimated": {
				"kind": "parts",
				"part": "variable",
				"help": "Variables written by abilities, which no message carries.",
				"required": false
			},
			"abilities": {
				"kind": "parts",
				"part": "ability",
				"help": "What the resource can do.",
				"required": false
			}
		}
	},
	"ability": {
		"about": "An ability of a resource. `duration` estimates in seconds how long a run takes.",
		"fields": {
			"title": {
				"kind": "text",
				"help": "For people; `{parameter}` is replaced by the value.",
				"required": false
			},
			"parameters": {
				"kind": "names",
				"help": "`{name: enumeration}`: one ability per value.",
				"required": false
			},
			"restart": {
				"kind": "flag",
				"help": "Only for getting back to work after trouble.",
				"required": false,
				"otherwise": false
			},
			"human": {
				"kind": "part",
				"part": "human",
				"help": "A person does it.",
				"required": false
			},
			"timeouts": {
				"kind": "part",
				"part": "timeouts",
				"help": "By when it must have reacted and finished, and what is done when it has not.",
				"required": false
			},
			"duration": {
				"kind": "interval",
				"help": "Seconds that a run is estimated to take, or the fewest and the most.",
				"required": false,
				"least": 0,
				"most": 86400
			},
			"enabled": {
				"kind": "predicate",
				"help": "The ability can be used now.",
				"required": false,
				"otherwise": true
			},
			"start": {
				"kind": "part",
				"part": "start",
				"help": "The start: a further guard, and its actions.",
				"required": false
			},
			"executing": {
				"kind": "predicate",
				"help": "It is under way.",
				"required": false,
				"otherwise": false
			},
			"finished": {
				"kind": "predicate",
				"help": "It is done; for use in other conditions.",
				"required": false,
				"otherwise": false
			},
			"finish": {
				"kind": "part",
				"part": "finish",
				"help": "The finish. An ability without one is done with its start.",
				"required": false
			},
			"cancel": {
				"kind": "part",
				"part": "cancel",
				"help": "What calls a running ability off.",
				"required": false
			},
			"effects": {
				"kind": "parts",
				"part": "effect",
				"help": "How the device is expected to react.",
				"required": false
			}
		}
	},
	"action": {
		"about": "A ROS 2 action of the device. A goal is sent when an output rises, and cancelled when it falls.",
		"fields": {
			"type": {
				"kind": "text",
				"help": "The action type, `package/action/Name`.",
				"required": true
			},
			"when": {
				"kind": "text",
				"help": "An output of type `bool`: a goal is sent when it becomes true, and cancelled when it becomes false.",
				"required": true
			},
			"status": {
				"kind": "text",
				"help": "The measured variable that says what has become of the goal.",
				"required": true
			},
			"deadline": {
				"kind": "number",
				"help": "Seconds without an answer of the server after which the goal is lost.",
				"required": false,
				"otherwise": 1,
				"above": 0,
				"most": 86400
			},
			"ignore": {
				"kind": "texts",
				"help": "Fields of the goal, of the feedback and of the result that are no variables.",
				"required": false
			},
			"goal": {
				"kind": "yaml",
				"help": "Stages from variables to the goal, as of an outgoing topic.",
				"required": false
			},
			"feedback": {
				"kind": "yaml",
				"help": "Stages from the feedback to variables, as of an incoming topic.",
				"required": false
			},
			"result": {
				"kind": "yaml",
				"help": "Stages from the result to variables, as of an incoming topic.",
				"required": false
			}
		}
	},
	"cancel": {
		"about": "What is done when a running ability is called off.",
		"fields": {
			"do": {
				"kind": "texts",
				"help": "Actions on outputs and estimates.",
				"required": true
			}
		}
	},
	"debounce": {
		"about": "A new value counts when it has been there for some time; until then the old one does.",
		"fields": {
			"fields": {
				"kind": "texts",
				"help": "The fields, which change together.",
				"required": true
			},
			"seconds": {
				"kind": "number",
				"help": "How long it must have been there.",
				"required": true,
				"above": 0,
				"most": 86400
			}
		}
	},
	"discretise": {
		"about": "Numbers become the value whose coordinates are within `tolerance` of each, else `otherwise`.",
		"fields": {
			"field": {
				"kind": "text",
				"help": "An array of numbers in the message, or a single number.",
				"required": true
			},
			"variable": {
				"kind": "text",
				"help": "What gets the name of the point.",
				"required": true
			},
			"values": {
				"kind": "numbers",
				"help": "The coordinates of each named point.",
				"required": false
			},
			"ranges": {
				"kind": "numbers",
				"help": "For a single number: the least and the greatest of each value, `null` where there is no bound.",
				"required": false
			},
			"tolerance": {
				"kind": "number",
				"help": "How far from a point each number may be.",
				"required": false,
				"above": 0
			},
			"otherwise": {
				"kind": "text",
				"help": "The value between points or ranges.",
				"required": false
			},
			"hysteresis": {
				"kind": "number",
				"help": "How much further than that a number must go for the value to be left again.",
				"required": false,
				"otherwise": 0,
				"least": 0
			}
		}
	},
	"effect": {
		"about": "How measured variables are expected to react; `takes` is its shortest and longest time in seconds.",
		"fields": {
			"kind": {
				"kind": "choice",
				"choices": [
					"starting",
					"executing",
					"finishing"
				],
				"help": "For the reader: when in a run it is expected.",
				"required": true
			},
			"when": {
				"kind": "predicate",
				"help": "The condition under which it happens, on measured and output variables.",
				"required": true
			},
			"do": {
				"kind": "texts",
				"help": "What changes, all at once: actions on measured variables.",
				"required": true
			},
			"takes": {
				"kind": "interval",
				"help": "Seconds, or the fewest and the most; emulated devices take so long.",
				"required": false,
				"least": 0,
				"most": 86400
			},
			"fault": {
				"kind": "flag",
				"help": "It may happen, but nobody counts on it.",
				"required": false,
				"otherwise": false
			}
		}
	},
	"every": {
		"about": "A period.",
		"fields": {
			"every": {
				"kind": "number",
				"help": "Seconds between two records.",
				"required": true,
				"above": 0,
				"most": 86400
			}
		}
	},
	"finish": {
		"about": "The finish of an ability: its guard and actions.",
		"fields": {
			"when": {
				"kind": "predicate",
				"help": "As soon as this holds, the finish actions are taken.",
				"required": true
			},
			"do": {
				"kind": "texts",
				"help": "Actions on outputs and estimates.",
				"required": false
			}
		}
	},
	"flow": {
		"about": "Records of topics or other flows: of one, of several as they arrive, or of several as one.",
		"fields": {
			"from": {
				"kind": "yaml",
				"help": "A topic or flow; a list of them; or `{alias: topic or flow}`, whose fields are then `alias.field`.",
				"required": true
			},
			"pipeline": {
				"kind": "yaml",
				"help": "Stages.",
				"required": false
			},
			"examples": {
				"kind": "yaml",
				"help": "What comes of what, checked by `check`.",
				"required": false
			}
		}
	},
	"human": {
		"about": "A person carries the ability out: what the watch says, and the measured variable that is the acknowledgement.",
		"fields": {
			"task": {
				"kind": "text",
				"help": "What the watch says.",
				"required": true
			},
			"acknowledgement": {
				"kind": "text",
				"help": "A measured `bool` of the resource.",
				"required": true
			}
		}
	},
	"map": {
		"about": "Each value becomes another.",
		"fields": {
			"field": {
				"kind": "text",
				"help": "The field of the message.",
				"required": true
			},
			"variable": {
				"kind": "text",
				"help": "The variable that corresponds to it.",
				"required": true
			},
			"values": {
				"kind": "named",
				"help": "What each value of the message means; for an outgoing topic, what is sent for each value of the variable.",
				"required": true
			},
			"otherwise": {
				"kind": "scalar",
				"help": "What all other values become; without it they are unknown.",
				"required": false
			}
		}
	},
	"match": {
		"about": "Texts are recognised: one kind of text makes a truth value, several make an enumeration.",
		"fields": {
			"field": {
				"kind": "text",
				"help": "A text of the message.",
				"required": true
			},
			"variable": {
				"kind": "text",
				"help": "What becomes of it.",
				"required": true
			},
			"contains": {
				"kind": "text",
				"help": "True for texts that contain this.",
				"required": false
			},
			"begins": {
				"kind": "text",
				"help": "True for texts that begin so.",
				"required": false
			},
			"ends": {
				"kind": "text",
				"help": "True for texts that end so.",
				"required": false
			},
			"equals": {
				"kind": "text",
				"help": "True for exactly this text.",
				"required": false
			},
			"values": {
				"kind": "words",
				"help": "The texts that mean each value.",
				"required": false
			},
			"otherwise": {
				"kind": "text",
				"help": "The value of all other texts; without it they are unknown.",
				"required": false
			}
		}
	},
	"member": {
		"about": "Whether a list contains an item.",
		"fields": {
			"field": {
				"kind": "text",
				"help": "A list of the message.",
				"required": true
			},
			"item": {
				"kind": "scalar",
				"help": "What is looked for.",
				"required": true
			},
			"variable": {
				"kind": "text",
				"help": "True when it is there.",
				"required": true
			}
		}
	},
	"override": {
		"about": "A person's live values for some fields, within bounds, for a while.",
		"fields": {
			"name": {
				"kind": "text",
				"help": "What it is called where it is set.",
				"required": true
			},
			"fields": {
				"kind": "bounds",
				"help": "The fields, each with the values allowed.",
				"required": true
			},
			"expires": {
				"kind": "number",
				"help": "Seconds after which it is gone.",
				"required": true,
				"above": 0,
				"most": 86400
			}
		}
	},
	"python": {
		"about": "A function of the station's own, in a file of its folder `stages`.",
		"fields": {
			"file": {
				"kind": "text",
				"help": "The file, as in `stages/force.py`.",
				"required": true
			},
			"function": {
				"kind": "text",
				"help": "The function's name. It is called with the fields it reads, and returns a dict of what it gives.",
				"required": true
			},
			"reads": {
				"kind": "names",
				"help": "The fields it is called with, and their types: `bool`, `0..9`, `{a, b}`, `real`, `text`.",
				"required": true,
				"loose": true
			},
			"gives": {
				"kind": "names",
				"help": "What it returns, and the types.",
				"required": true,
				"loose": true
			},
			"deadline": {
				"kind": "number",
				"help": "Seconds within which it answers.",
				"required": false,
				"otherwise": 0.05,
				"above": 0,
				"most": 60
			}
		}
	},
	"remember": {
		"about": "A variable keeps the last value of another, but for the values in `except`.",
		"fields": {
			"variable": {
				"kind": "text",
				"help": "The variable that keeps the value.",
				"required": true
			},
			"of": {
				"kind": "text",
				"help": "The field or variable, of the same pipeline, whose value is kept.",
				"required": true
			},
			"except": {
				"kind": "texts",
				"help": "Values that are not kept.",
				"required": false
			}
		}
	},
	"service": {
		"about": "A ROS 2 service of the device. It is called when an output rises, or every so often, or both.",
		"fields": {
			"type": {
				"kind": "text",
				"help": "The service type, `package/srv/Name`.",
				"required": true
			},
			"when": {
				"kind": "text",
				"help": "An output of type `bool`: the service is called when it becomes true.",
				"required": false
			},
			"every": {
				"kind": "number",
				"help": "Seconds from one call to the next.",
				"required": false,
				"above": 0,
				"most": 86400
			},
			"deadline": {
				"kind": "number",
				"help": "Seconds without an answer after which what the answer says is unknown.",
				"required": false,
				"otherwise": 1,
				"above": 0,
				"most": 86400
			},
			"ignore": {
				"kind": "texts",
				"help": "Fields of the request and of the response that are no variables.",
				"required": false
			},
			"request": {
				"kind": "yaml",
				"help": "Stages from variables to the request, as of an outgoing topic.",
				"required": false
			},
			"response": {
				"kind": "yaml",
				"help": "Stages from the response to variables, as of an incoming topic.",
				"required": false
			}
		}
	},
	"stage": {
		"about": "One stage of a pipeline: exactly one kind. Fields and variables of one name are mapped without being asked.",
		"fields": {
			"rename": {
				"kind": "names",
				"help": "Which field is which variable, where their names differ: `{field: variable}`.",
				"required": false,
				"loose": true
			},
			"constant": {
				"kind": "named",
				"help": "Fields with a fixed value; for outgoing topics.",
				"required": false
			},
			"expression": {
				"kind": "named",
				"help": "Values computed from others: `{name: expression}`.",
				"required": false
			},
			"filter": {
				"kind": "predicate",
				"help": "Only records for which this holds go on.",
				"required": false
			},
			"discretise": {
				"kind": "part",
				"part": "discretise",
				"help": "From numbers to the name of a point; for incoming topics.",
				"required": false
			},
			"undiscretise": {
				"kind": "part",
				"part": "undiscretise",
				"help": "From the name of a point to its numbers; for outgoing topics.",
				"required": false
			},
			"map": {
				"kind": "part",
				"part": "map",
				"help": "From each value to another.",
				"required": false
			},
			"table": {
				"kind": "part",
				"part": "table",
				"help": "From several values to several others, by rows.",
				"required": false
			},
			"match": {
				"kind": "part",
				"part": "match",
				"help": "From texts to truth values or names; for incoming topics.",
				"required": false
			},
			"member": {
				"kind": "part",
				"part": "member",
				"help": "Whether a list contains an item; for incoming topics.",
				"required": false
			},
			"remember": {
				"kind": "part",
				"part": "remember",
				"help": "Keep the last value of another variable; for incoming topics.",
				"required": false
			},
			"debounce": {
				"kind": "part",
				"part": "debounce",
				"help": "A new value counts when it has been there for some time; for incoming topics.",
				"required": false
			},
			"limit": {
				"kind": "part",
				"part": "every",
				"help": "At most one record per time, the newest.",
				"required": false
			},
			"tick": {
				"kind": "part",
				"part": "every",
				"help": "The last record again, every so often.",
				"required": false
			},
			"override": {
				"kind": "part",
				"part": "override",
				"help": "A person's live values, within bounds.",
				"required": false
			},
			"fold": {
				"kind": "texts",
				"help": "Fields that are unknown keep their last value; an empty list means all.",
				"required": false
			},
			"timeout": {
				"kind": "part",
				"part": "timeout",
				"help": "Fields are unknown when no record has come for some time; for incoming topics.",
				"required": false
			},
			"python": {
				"kind": "part",
				"part": "python",
				"help": "A function of the station's own.",
				"required": false
			}
		}
	},
	"start": {
		"about": "The start of an ability: a further guard beside `enabled`, and the actions.",
		"fields": {
			"when": {
				"kind": "predicate",
				"help": "What must hold for a start beside `enabled`.",
				"required": false,
				"otherwise": true
			},
			"do": {
				"kind": "texts",
				"help": "Actions on outputs and estimates, such as `wanted := closed`.",
				"required": false
			}
		}
	},
	"table": {
		"about": "The first row that fits says what the variables are.",
		"fields": {
			"fields": {
				"kind": "texts",
				"help": "What is looked at.",
				"required": true
			},
			"variables": {
				"kind": "texts",
				"help": "What it gives.",
				"required": true
			},
			"rows": {
				"kind": "rows",
				"help": "The rows, in order.",
				"required": true
			},
			"otherwise": {
				"kind": "scalars",
				"help": "What it gives when no row fits; without it the variables are unknown.",
				"required": false
			}
		}
	},
	"timeout": {
		"about": "Fields are unknown when no record has come for some time.",
		"fields": {
			"fields": {
				"kind": "texts",
				"help": "The fields.",
				"required": true
			},
			"seconds": {
				"kind": "number",
				"help": "How long they count.",
				"required": true,
				"above": 0,
				"most": 86400
			}
		}
	},
	"timeouts": {
		"about": "Seconds after the start: by when it must have reacted, and have finished; and what is done when it has not.",
		"fields": {
			"react": {
				"kind": "number",
				"help": "By when it must have been seen executing, or have finished.",
				"required": false,
				"least": 0,
				"most": 86400
			},
			"finish": {
				"kind": "number",
				"help": "By when it must have finished.",
				"required": false,
				"least": 0,
				"most": 86400
			},
			"then": {
				"kind": "choice",
				"choices": [
					"alarm",
					"replan"
				],
				"help": "What is done beside the alarm: nothing, or it is called off and a plan is made again.",
				"required": false,
				"otherwise": "alarm"
			},
			"retries": {
				"kind": "number",
				"help": "How often it is tried again by such a plan, until it is taken out of service and done without.",
				"required": false,
				"otherwise": 0,
				"whole": true,
				"least": 0,
				"most": 100
			}
		}
	},
	"topic": {
		"about": "A ROS 2 topic. An incoming one is stale after `deadline` seconds; an outgoing one is repeated `every` seconds.",
		"fields": {
			"type": {
				"kind": "text",
				"help": "The message type, `package/msg/Name`.",
				"required": true
			},
			"direction": {
				"kind": "choice",
				"choices": [
					"in",
					"out"
				],
				"help": "`in`: from a device; `out`: to a device.",
				"required": true
			},
			"deadline": {
				"kind": "number",
				"help": "Seconds without a message after which the topic's variables are unknown; incoming topics only.",
				"required": false,
				"above": 0,
				"most": 86400
			},
			"every": {
				"kind": "number",
				"help": "Seconds after which the message is repeated; outgoing topics only.",
				"required": false,
				"above": 0,
				"most": 86400
			},
			"quality": {
				"kind": "choice",
				"choices": [
					"reliable",
					"sensor_data",
					"latched"
				],
				"help": "The topic's quality of service, by name or in full.",
				"required": false,
				"otherwise": "reliable"
			},
			"ros": {
				"kind": "choice",
				"choices": [
					1,
					2
				],
				"help": "Which ROS the device speaks: 2, or 1, which is reached through a rosbridge server.",
				"required": false,
				"otherwise": 2,
				"whole": true
			},
			"ignore": {
				"kind": "texts",
				"help": "Fields that are no variables.",
				"required": false
			},
			"pipeline": {
				"kind": "yaml",
				"help": "Stages, where names alone do not tell what belongs together.",
				"required": false
			},
			"examples": {
				"kind": "yaml",
				"help": "What comes of what, checked by `check`.",
				"required": false
			}
		}
	},
	"undiscretise": {
		"about": "A value becomes its coordinates.",
		"fields": {
			"variable": {
				"kind": "text",
				"help": "The variable whose value names a point.",
				"required": true
			},
			"field": {
				"kind": "text",
				"help": "The array of numbers in the message.",
				"required": true
			},
			"values": {
				"kind": "numbers",
				"help": "The coordinates of every value.",
				"required": true
			}
		}
	},
	"operation": {
		"about": "A production operation: active from its precondition to its goal. The highest `priority` is kept longest. `local` is a formula of linear temporal logic over the run from activation to goal.",
		"fields": {
			"title": {
				"kind": "text",
				"help": "For people; `{parameter}` is replaced by the value.",
				"required": false
			},
			"parameters": {
				"kind": "names",
				"help": "`{name: enumeration}`: one operation per value.",
				"required": false
			},
			"precondition": {
				"kind": "predicate",
				"help": "It becomes active when this holds, and the goal does not.",
				"required": true
			},
			"goal": {
				"kind": "predicate",
				"help": "It is completed when this holds.",
				"required": true
			},
			"local": {
				"kind": "predicate",
				"help": "A formula that holds from its activation to its goal, such as `not bad U good`.",
				"required": false
			},
			"priority": {
				"kind": "number",
				"help": "When not all active operations can be planned together, the lowest are left out first.",
				"required": false,
				"otherwise": 0,
				"whole": true
			},
			"repeat": {
				"kind": "flag",
				"help": "Whether it can become active again once it was completed; else only after it was reset.",
				"required": false,
				"otherwise": true
			}
		}
	},
	"specification": {
		"about": "What must never be. One of: states that are `forbidden`; `never` one thing `while` another; abilities that are `exclusive`; a `zone` that resources share; an `order` of conditions.",
		"fields": {
			"title": {
				"kind": "text",
				"help": "For people; `{parameter}` is replaced by the value.",
				"required": false
			},
			"parameters": {
				"kind": "names",
				"help": "`{name: enumeration}`: one specification per value.",
				"required": false
			},
			"forbidden": {
				"kind": "predicate",
				"help": "States that must never be.",
				"required": false
			},
			"never": {
				"kind": "predicate",
				"help": "What must not be `while` something else holds.",
				"required": false
			},
			"while": {
				"kind": "predicate",
				"help": "While what `never` must not be.",
				"required": false
			},
			"exclusive": {
				"kind": "texts",
				"help": "Abilities of which no two execute at once.",
				"required": false
			},
			"zone": {
				"kind": "zone",
				"help": "Resources that share a space, each with the condition under which it is inside.",
				"required": false
			},
			"order": {
				"kind": "predicates",
				"help": "Conditions none of which holds without the one before.",
				"required": false
			}
		}
	},
	"work_master": {
		"about": "What a job consists of: its operations with their order, and the estimated values a new product `brings`.",
		"fields": {
			"title": {
				"kind": "text",
				"help": "For people.",
				"required": false
			},
			"brings": {
				"kind": "texts",
				"help": "The estimated values of a new product, such as `part := absent`.",
				"required": false
			},
			"operations": {
				"kind": "yaml",
				"help": "The operations of a job, each with what comes before it.",
				"required": true
			}
		}
	}
};
