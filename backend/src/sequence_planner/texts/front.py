"""English texts that are read with every page: what others are made of, and why somebody is refused or not heard."""

from __future__ import annotations

from typing import Final

FRONT: Final[dict[str, str]] = {
    # What other texts are made of; `as-it-was` is what was written down as a string.
    "sentences": "{first} {second}",
    "quoted": "“{title}”",
    "list.more": "{count} more",
    "list.and": "{most} and {last}",
    "as-it-was": "{text}",
    "list.semicolon": "{first}; {second}",
    # The server and the controller.
    "refused.preparing": "The station is being prepared",
    "refused.preparing.again": "Try again in a moment.",
    "refused.preparing.network": "The station is being prepared and has not joined the network. Try again in a moment.",
    "refused.preparing.abilities": (
        "The station is being prepared, so it is not known yet what it can do. Try again in a moment."
    ),
    "refused.preparing.stays-at-rest": "Nothing goes on by itself before a person starts production.",
    "refused.preparing.stays-at-rest-if": (
        "Should it take over within {seconds} s, nothing goes on by itself before a person starts production."
    ),
    "refused.on-standby": "This station stands by",
    "refused.on-standby.other": (
        "Another station commands the devices, and this station stands by for it. Open that one's page."
    ),
    "refused.on-standby.holder": (
        "{holder} commands the devices, and this station stands by for it. Open that one's page."
    ),
    "refused.on-standby.model": "The model is edited at the station that commands. Open its page.",
    "refused.lease-not-renewed": "The lease of the command is not renewed",
    "refused.lease-not-renewed.why": (
        "This station cannot renew the lease of the command: {why}. Try again in a moment."
    ),
    "refused.controller-busy": "Too much is asked at once",
    "refused.controller-busy.most": "{most} questions wait for their answers already. Try again in a moment.",
    "refused.answer-timeout": "The answer would come too late",
    "refused.answer-timeout.again": "The answer was not found in time. Nothing was changed by asking; try again.",
    "refused.controller-error": "The controller failed",
    "refused.controller-error.log": "The controller met an error of its own; it is written in the controller's log.",
    "refused.malformed-command": "The command cannot be read",
    "refused.malformed-command.too-long": "The line is longer than {longest} bytes.",
    "refused.malformed-command.places": "Not a command of this controller: see {places}.",
    "refused.command-expired": "The command came too late",
    "refused.command-expired.look": "It came too late and was not carried out. Look at the station, then try again.",
    "refused.controller-unavailable": "The controller is not heard",
    "refused.controller-unavailable.not-sent": "Nothing was sent. Start the controller, then try again.",
    "refused.controller-unavailable.silent": (
        "The controller is silent, so nothing is known of the station now. Try again."
    ),
    "refused.controller-timeout": "The controller did not answer",
    "refused.controller-timeout.command": (
        "It is not known whether the command was carried out: look at the station before trying again."
    ),
    "refused.controller-timeout.question": "Nothing was changed by asking; try again.",
    "refused.storage-unavailable": "The database is not available",
    "refused.storage-unavailable.again": (
        "The station's database does not answer, so nobody can be let in and nothing is recorded. Try again."
    ),
    "refused.internal-error": "Internal error",
    "refused.internal-error.log": "The server met an error of its own; it is written in the server's log.",
    # Tasks of people.
    "refused.task-gone": "This task is gone",
    "refused.task-gone.look": "Look at what is asked for now.",
    "refused.task-gone.id": "Task {task} is not open: it was done or withdrawn. Look at what is asked for now.",
    "refused.task-changed": "This task has changed",
    "refused.task-changed.look": "Look at what is asked for now.",
    "refused.task-changed.revision": (
        "Task {task} is at revision {revision}, and revision {seen} was seen. Read it again."
    ),
    "refused.not-your-task": "The task is somebody else's",
    "refused.not-your-task.watch": "{watch} is for the tasks of {resource}, and this is none of them.",
    # Who asks, and what they may.
    "refused.signed-out": "Nobody is signed in",
    "refused.signed-out.sign-in": "Sign in, then try again.",
    "refused.signed-out.key": "The key is unknown, has expired or was revoked. Ask an administrator for another.",
    "refused.signed-out.ended": "Your session has ended: sign in again.",
    "refused.signed-out.key-ended": "The key works no more. Ask an administrator for another key.",
    "refused.password-must-change": "The password must be changed",
    "refused.password-must-change.own": "Your password was set by somebody else. Choose one of your own first.",
    "refused.role-too-low": "You may not do this",
    "refused.role-too-low.watch": "This takes a paired watch; you have the role {role}. Ask an administrator.",
    "refused.role-too-low.role": "This takes the role {needed}; you have the role {role}. Ask an administrator.",
    "refused.scope-missing": "The key may not do this",
    "refused.scope-missing.none": "The key {key} may not do this: no key may do this.",
    "refused.scope-missing.scope": "The key {key} may not do this: it takes one with the scope {scope}.",
    "refused.wearable-unconfirmed": "The watch is not confirmed yet",
    "refused.wearable-unconfirmed.confirm": "Whoever made the code must first confirm this watch.",
    "refused.name-taken": "Name taken",
    "refused.name-taken.there": (
        "The name `{name}` is taken, or looks like one that is: `{other}` is there already. Take one that nobody "
        "mistakes."
    ),
    "refused.name-taken.program": (
        "The name `{name}` is taken, or looks like one that is: the program goes by it. Take one that nobody mistakes."
    ),
    "refused.user-changed": "Changed meanwhile",
    "refused.user-changed.look": "{name} has been changed meanwhile: look at what is there now, and change that.",
    "refused.role-from-provider": "The provider decides",
    "refused.role-from-provider.issuer": "The role of {name} is what {issuer} says at each sign-in: change it there.",
    "refused.last-administrator": "Last administrator",
    "refused.last-administrator.other": "{name} is the last administrator: make somebody else administrator first.",
    "refused.no-password-here": "No password here",
    "refused.no-password-here.issuer": "{name} signs in with the provider {issuer}, and has no password here.",
    "refused.no-user": "No such person",
    "refused.no-user.id": "There is no person with this id. Look at who there is.",
    "refused.no-user.name": "There is nobody of the name `{name}`: `users list` shows who there is.",
    "refused.weak-password": "Too weak a password",
    "refused.weak-password.length": "This cannot be the password: it has to have {shortest} to {longest} characters.",
    "refused.weak-password.repeated": "This cannot be the password: it is one character over and over.",
    "refused.weak-password.common": "This cannot be the password: it is among the first that somebody would try.",
    "refused.weak-password.name": "This cannot be the password: it has the name in it.",
    "refused.weak-password.same": "This cannot be the password: it is the one that was to be changed.",
    "refused.busy": "Busy",
    "refused.busy.passwords": "Too many passwords are being checked right now. Try again in a few seconds.",
    "refused.invalid-name": "Not a name",
    "refused.invalid-name.too-long": "This cannot be a name: it is longer than {longest} characters.",
    "refused.invalid-name.length": "This cannot be a name: it has to have 1 to {longest} characters.",
    "refused.invalid-name.hidden": (
        "This cannot be a name: it has characters that do not show; type it again instead of copying it."
    ),
    "refused.invalid-name.no-letter": "This cannot be a name: it has neither a letter nor a digit.",
    "refused.invalid-name.marks": "This cannot be a name: it has more than {most} marks on one letter.",
    "refused.wrong-name-or-password": "Not signed in",
    "refused.wrong-name-or-password.again": (
        "The name or the password is wrong. Try again, or ask an administrator for another password."
    ),
    "refused.no-password": "No password",
    "refused.no-password.demonstration": "A demonstration has no password that could be changed.",
    "refused.no-password.provider": "You sign in with a provider, and have no password here: change it there.",
    "refused.wrong-password": "Wrong password",
    "refused.wrong-password.old": "The old password is wrong: type the one that you sign in with now.",
    "refused.too-many-attempts": "Too many attempts",
    "refused.too-many-attempts.seconds": "There were too many wrong attempts. Try again in {seconds} s.",
    "refused.setup-link-invalid": "Link does not work",
    "refused.setup-link-invalid.new": (
        "This link does not work, or no longer: it works once, for 15 minutes, while there is no administrator. On "
        "the station's computer, sequence-planner users setup-link prints a new one."
    ),
    "refused.administrator-exists": "Administrator exists",
    "refused.administrator-exists.ask": "There is an administrator already, who can add people and set passwords.",
    "refused.no-provider": "There is no provider",
    "refused.no-provider.password": "This station has no provider: sign in with a name and a password.",
    "refused.no-demonstration": "No demonstration here",
    "refused.no-demonstration.emulated": (
        "A demonstration can be opened at the machine itself, while all devices are emulated. Sign in instead."
    ),
    "refused.provider-unavailable": "The provider cannot be used",
    "refused.provider-unavailable.why": (
        "The provider cannot be used now: {why}. Try again, or sign in with a password if you have one here."
    ),
    "refused.provider-answer-invalid": "Not signed in",
    "refused.provider-answer-invalid.why": "What came from the provider does not hold: {why}. Begin to sign in again.",
    "refused.sign-in-not-begun": "Not signed in",
    "refused.sign-in-not-begun.again": (
        "This sign-in was not begun in this browser, was finished already, or took longer than ten minutes. Begin "
        "to sign in again."
    ),
    "refused.provider-refused": "Not signed in",
    "refused.provider-refused.code": (
        "The provider has signed nobody in ({code}). Begin again, or ask who looks after it."
    ),
    "refused.no-role": "No role here",
    "refused.no-role.ask": (
        "You are known to the provider, but in none of the groups that may use this station. Ask an administrator."
    ),
    "refused.disabled": "Disabled here",
    "refused.disabled.ask": "An administrator of this station has disabled your account. Ask there.",
    # Watches and keys.
    "refused.wrong-code": "Code does not work",
    "refused.wrong-code.again": (
        "This code does not work, or no longer: it works once, within two minutes. Ask for a new one."
    ),
    "refused.wearable-not-waiting": "Watch does not wait",
    "refused.wearable-not-waiting.state": "The watch {name} does not wait to be let in: it is {state}.",
    "refused.no-wearable": "No such watch",
    "refused.no-wearable.id": "There is no watch with this id, or nobody has let it in within two minutes.",
    "refused.wearable-exists": "Watch exists",
    "refused.wearable-exists.name": "There is a watch `{name}` already: take another name, or revoke that one.",
    "refused.too-many-offers": "Too many offers",
    "refused.too-many-offers.most": "There are {most} offers already: withdraw one, or wait until they expire.",
    "refused.no-offer": "No such offer",
    "refused.no-offer.used": "There is no such offer: its code was used, withdrawn, or has expired.",
    "refused.no-such-instruction": "There is no such picture or video",
    "refused.no-such-instruction.name": (
        "The folder `instructions` of the station has no file {name} that can be shown. GET /tasks names those of "
        "tasks."
    ),
    "refused.no-such-resource": "A watch cannot serve this resource",
    "refused.no-such-resource.choose": (
        '"{resource}" has no tasks for people. Choose one of the resources that GET /wearables lists.'
    ),
    "refused.no-scope": "No scope",
    "refused.no-scope.say": "Say what the key is for: a key without a scope opens nothing.",
    "refused.invalid-overlap": "Unfit overlap",
    "refused.invalid-overlap.hours": "The secret that is replaced works for 0 to {longest} hours more.",
    "refused.key-expired": "The key works no more",
    "refused.key-expired.another": "Make another key: this one works no more.",
    "refused.no-key": "No such key",
    "refused.no-key.id": "There is no key with this id. Look at those that there are.",
    "refused.invalid-days": "Unfit days",
    "refused.invalid-days.most": "A key works for 1 to {longest} days.",
    # How a request has to be.
    "refused.revision-needed": "Which revision was seen is not said",
    "refused.revision-needed.header": "Name the revision that you saw in the header If-Match, in double quotes.",
    "refused.not-json": "The body is not declared as JSON",
    "refused.not-json.header": "Send the body as JSON, with the header Content-Type: application/json.",
    "refused.malformed-json": "The body is not JSON",
    "refused.malformed-json.why": "The body is not JSON: {why}.",
    "refused.invalid-request": "The request is not as expected",
    "refused.invalid-request.character": "No text has the character 0.",
    "refused.conflicting-lengths": "The length is said twice",
    "refused.conflicting-lengths.either": "Send either Content-Length or Transfer-Encoding, not both.",
    "refused.body-too-large": "The body is too large",
    "refused.body-too-large.most": "A body may have {largest} bytes at most: send less.",
    "refused.body-too-slow": "The body did not come in time",
    "refused.body-too-slow.seconds": "A body must be there within {seconds} s. Send it again, all at once.",
    "refused.not-found": "Not Found",
    "refused.not-found.address": "There is nothing at this address. GET /api/v1/openapi.json describes what there is.",
    "refused.not-found.character": "Nothing has a control character, or no UTF-8, in its address. Leave that out.",
    "refused.no-host": "No single Host header",
    "refused.no-host.one": "Send one Host header.",
    "refused.wrong-host": "Another host was meant",
    "refused.wrong-host.hosts": "This server answers to {hosts} only.",
    "refused.foreign-origin": "Sent by a foreign page",
    "refused.foreign-origin.open": "The request comes from a page of another site; open this server's own page.",
    "refused.not-the-proxy": "Not sent by the proxy",
    "refused.not-the-proxy.open": "This server is reached through its proxy only; open its public address.",
    "refused.not-encrypted": "Not sent over HTTPS",
    "refused.not-encrypted.https": (
        "Open it by https. (The proxy must say so with one header, X-Forwarded-Proto: https.)"
    ),
    "refused.no-client-address": "The proxy does not say who asks",
    "refused.no-client-address.header": "The proxy must append its client's address to the header X-Forwarded-For.",
    "refused.head-too-large": "The head is too large",
    "refused.bad-request": "Bad Request",
    "refused.bad-request.unreadable": (
        "The body cannot be read: it has to be JSON in UTF-8, and not nested more than some hundred times."
    ),
    "refused.method-not-allowed": "Method Not Allowed",
    "refused.method-not-allowed.allow": "This address does not know the method; the header Allow names those it knows.",
}
