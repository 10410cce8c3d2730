"""A station that uses all that a model can say for short: sets, orders, relations, maps, predicates, quantifiers."""

from __future__ import annotations

SHORTHAND = {
    "station.yaml": """\
name: press
enumerations:
  spot: [home, left, right, out] # where something can be
  pose: {values: [nowhere], includes: [spot]}
  part: {values: [p1, p2, p3], ordered: true}
  state: [empty, placed, tight]
  grip: [bare, big, small]
sets:
  free: {of: spot, values: [home, out]}
  work: {of: spot, except: [free]}
  ends: {of: part, values: [p1, p3]}
relations:
  near: {between: [spot, spot], symmetric: true, pairs: [[home, work], [left, 'right'], [[home, left], out]]}
  fits: {between: [grip, state], pairs: [[big, [placed, tight]]]}
maps:
  grip_for: {from: part, to: grip, values: {p2: big, ends: small}} # and this stays
  after_state: {from: state, to: state, values: {empty: placed}, otherwise: tight}
  is_heavy: {from: grip, to: bool, values: {big: true}, otherwise: false}
predicates:
  all_tight: "all p in part: bolts[p] == tight"
  is_done:
    title: "{which} is done"
    parameters: {which: part}
    when: bolts[which] == tight and (which == p1 or bolts[previous(which)] == tight)
estimated:
  bolts: {for: {where: part}, type: state, initial: empty}
  goal: {type: spot, initial: home}
  chosen: {type: part, initial: p1}
alarms:
  stuck: {when: '(count p in ends where p != chosen: bolts[p] == placed) >= 2 and all_tight', title: Stuck}
rest: "none p in part where p < chosen and is_done(p): bolts[p] == tight"
""",
    "resources/arm.yaml": """\
measured:
  at: {type: pose, initial: nowhere}
  held: {type: grip, initial: bare}
output:
  target: {type: spot}
  side: {type: sides}
sets:
  sides: {of: spot, values: [left, right]} # of the arm alone
  lone: {of: sides, except: [right]}
relations:
  across: {between: [sides, sides], pairs: [[lone, right]]}
maps:
  mirrored: {from: sides, to: sides, values: {lone: right, right: left}}
predicates:
  is_aside: {parameters: {where: sides}, when: 'at in sides and (at == where or at == mirrored[where])'}
  is_at: {parameters: {q: spot}, when: at == q and target == q}
  is_free: at in free and not is_at(left)
abilities:
  turn:
    parameters: {where: sides}
    enabled: "is_aside(where) and across(side, right) and any s in sides: s != where and side == s"
    start: {do: [side := where]}
    effects:
      turns: {for: {from_side: sides}, when: side != at and at == from_side, do: [at := side]}
  move:
    title: "Move to {to}"
    parameters: {to: free}
    enabled: near(at, to) and not is_at(to) and is_free
    start: {do: [target := to]}
    executing: target == to and at != to
    finish: {when: is_at(to), do: ["all p in part where p == next(chosen): bolts[p] := placed if p != first(ends)"]}
    effects:
      arrives: {kind: executing, when: target != at, do: [at := target]}
  grip:
    parameters: {one: ends}
    enabled: held != grip_for[one] and bolts[chosen] == after_state[empty] and fits(held, placed)
    start: {do: ["goal := left if is_heavy[held]"]}
    executing: "at least 1 p in {p1, p2}, q in ends: bolts[p] != bolts[q] and p != last(part)"
    finish: {when: "exactly 1 q in ends: is_done(q) or bolts[q] == placed"}
    effects:
      holds: {kind: executing, when: held == bare, do: ["held := small"]}
      slips:
        {for: {it: grip}, when: "held == it and it != bare and grip_for[one] == it", do: [held := bare], fault: true}
""",
    "operations.yaml": """\
fasten:
  precondition: not is_done(p1) and arm.is_at(home)
  goal: "all p in part: is_done(p)"
  local: "all p in ends where p > p1: F (bolts[p] == tight)"
""",
    "specifications.yaml": """\
aside: {parameters: {where: arm.sides}, forbidden: 'arm.at == where and arm.side == where and arm.at in arm.lone'}
apart: {never: 'at least 3 p in part: bolts[p] == placed', while: 'any s in work: near(s, goal)'}
""",
}
