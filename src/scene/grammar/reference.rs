//! Generates the documentation page of the scene language from the grammar.

use std::fmt::Write as _;

use super::{KeySpec, Kind, Rule, SCENE, TableSpec, quoted};
use crate::scene::expression::{CONSTANTS, FUNCTIONS};
use crate::scene::{ListedMeasure, Measure};

/// Returns the documentation of all keys of the scene language, as Markdown.
pub fn reference() -> String {
    let text = String::from(
        "# The scene language, key by key\n\n\
         This page is made from the description of the keys that also reads and checks scenes; the test\n\
         `tests/docs/reference.rs` keeps it so. Coordinates are right-handed: x right, y up, z towards the viewer.\n\n\
         Wherever a number stands, a string with a [formula](#formulas) can stand: `radius = \"2*r\"`.\n",
    );
    let mut page = Page { text, sections: Vec::new() };
    page.section("", &SCENE);
    page.formulas();
    page.text.push_str(COPIES);
    page.text.push_str(MOTION);
    page.text.push_str(CONTACTS);
    page.text.push_str(PARTICLES);
    page.labels();
    page.text
}

/// The documentation section on contacts.
const CONTACTS: &str = "
## Contacts

```toml
[simulation]
duration = 4
gravity = [0, -9.81, 0]
contacts = \"event-driven\"

[body.ball]
shape.sphere.radius = 0.1
location = [0, 2, 0]
restitution = 0.8

[environment.ground]
friction = 0.3

[label.count]
text = \"${impacts} impacts, ${ball.impacts.ground} with the ground\"
```

Without `contacts`, bodies pass through each other, and a warning names the first two that do. With `\"event-driven\"`, the program
finds the time of each impact within the step. Newton's law gives the rebound, Coulomb's law the friction. If a rebound is too small to see,
the body stays in contact and then sticks, slides or rolls according to the forces on it.

- **What collides**: all bodies except axes. Bodies connected by a joint pass through each other unless the joint has
  `collides = true`. Bodies with the same `collision_group` pass through each other, too, and a body with `collides = false` passes
  through everything. Contacts of a torus need `\"time-stepping\"`; or build it as a `compound`.
- **The ground** lies at height 0 by default. It stops bodies, and has its own `restitution`, `friction` and
  `rolling_friction`. There is none with `ground = false` or in an environment without ground.
- **Two surfaces**: the larger restitution, the geometric mean of the frictions and the larger rolling friction count. If only one of
  the two bodies has a value, that value counts. If neither has one, the values are 0, 0.5 and 0 m.
- **Simultaneous impacts** happen one after another, the fastest approach first. Ties go to the bodies that come first in the scene.
  So in a Newton's cradle as many balls leave as arrive.
- **Too many events**: some bodies hit, grip and release each other again and again within one step, such as a chain that falls on the floor.
  Time-stepping (Moreau's scheme) then advances these bodies to the end of the step or for some more steps. All impacts within a substep
  happen at once, by Poisson's law, without momentary rebounds. The energy stays balanced.
- **Heaps**: if more than six pairs of bodies touch and some begin to slide or separate, time-stepping advances them until they rest, together
  with any bodies that may hit them within a step.
- **Several points**: bodies that touch at several points stick as long as friction within Coulomb's law can hold them, however the points
  share it. They slide from the moment at which it cannot.
- **At rest**: bodies that have rested on each other for eight steps, with forces that balance, are frozen until something touches them or a
  force on them changes. So a heap at rest costs nothing.
- **Integrators**: the default is `velocity-verlet`. Methods of first order (`euler-cromer`, `explicit-euler`) are no more accurate at
  impacts than between them; a warning gives the energy error.
- **Energy**: impacts and friction have the accounts `impacts` and `friction` in the energy balance, and are not part of the drift.
- **Display**: `arrows.weight`, `arrows.normal` and `arrows.friction` of a body show the forces on it at their points of action. Labels
  can show the count `impacts`, and `jabuka export SCENE --events FILE.csv` writes a row for each impact.

### Many bodies: time-stepping

```toml
[simulation]
duration = 6
gravity = [0, -9.81, 0]
contacts = \"time-stepping\"

[body.brick]
shape.box.size = [0.4, 0.2, 0.2]
location = [0, 0.1, 0]
friction = 0.6
repeat.grid = { count = [4, 10, 1], spacing = [0.42, 0.2, 0] }
```

With `contacts = \"time-stepping\"`, all contacts of a timestep are solved together. The cost of a step is roughly proportional to the number of
contacts, so thousands of bodies are possible: piles, towers and machines. Bodies, surfaces and
joints are described in the same way for both schemes. Choose by scene:

| | `event-driven` | `time-stepping` |
| --- | --- | --- |
| bodies in contact at the same time | tens | tens of thousands |
| a rebound with restitution 1 | keeps its height | loses height; a warning says how much |
| a touching Newton's cradle | as many balls leave as arrive | the balls swing together |
| resting bodies | touch exactly | sink into each other by up to a percent of their thickness |
| integrators | any that keeps joints | `euler-cromer` |
| joints | all, exact to rounding | not `gear` and `pulley`; the others give way a little |
| rebounds of bodies on joints | exact | in the step after the impact |
| forces and torques of joints, in labels, arrows and tables | yes | refused |
| a motor with `angle` or `position` | exact, or with a `stiffness` | with a `stiffness` |
| torus | refused | a ring of capsules |
| rolling friction | yes | refused |

- **Few bodies**: if forces move at most sixty bodies, and none that collides is a torus, Moreau's scheme computes their contacts.
  Joints are exact then, bodies do not sink into each other, and bodies without joints meet where and when they touch within a step. Rebounds keep their height, and gears, pulleys, rolling friction, exact motors and the forces of joints are there. What a step can change sets the accuracy.
  Two bodies that touch no others rebound by the ratio of speeds that `restitution` gives. Where more bodies touch, each contact gives back
  this part of its impulse, which is another speed where there is friction or a joint.
- **Energy**: the work of contacts, joints and motors is booked, and is not part of the drift. So the drift says nothing about joints that give
  way or contacts that take too much: the summary names the energy that each of them took. The drift is relative to the largest kinetic
  energy, or to the energy that contacts took, or to the work of motions and motors, if that is more: bodies that only settle hardly move.
- **The step**: `step` determines the accuracy. Contacts are as stiff as the step allows: with half the step, piles sink a quarter as deep. By
  default, the step is 1/240 s, halved until the thinnest body sinks in by at most 3 % of its thickness under ten times its weight. This gives
  1/240 s for a thickness of 10 cm, and 1/960 s for 1 cm. `step` can be longer or shorter. In a tower, each body carries all bodies above it, so
  low bodies sink in more. Of many bodies, a slender tower can fall; with half the step, it stands.
- **Sliding and spinning**: a body that slides and spins at once on several points gets the full friction against both. In reality, each weakens
  the other. Use `event-driven` contacts for such bodies.
- **Flat faces** press with their corners or rims, in both schemes. So a disk that spins on its face stops in two thirds of the time that an even
  pressure would need, and a square plate in about half of it.
- **Joints that carry much**: joints are solved one after the other, so they yield. A beam of eight welded parts of 0.5 m and 5 kg with a load of
  100 kg sags by 0.08 m at 1/240 s, and by a quarter of that with half the step. A single `compound` does not bend. A heavy load on a chain of
  light links, of length L and mass m each, needs a step below √(m L/F) for the tension F. With a longer step, the links vibrate until the chain
  flies apart.
- **Machines in contact**: a machine on joints loses the part ½ ω² Δt of its rotation in each second while one of its bodies touches another one: a
  vehicle in a curve, or an arm that leans on a stop. At 1 rad/s and 1/240 s this is 0.2 %. Without a contact, it keeps its rotation.
- **Shapes**: a frustum is a hull with 32 sides. A torus is a ring of capsules, off by at most 1 % of its tube, so bodies that roll along it lose
  energy at the kinks. A moving mesh is its convex hull if it is convex. Otherwise it is cut into convex parts along its own faces, up to 128
  parts. A mesh that needs more parts is replaced by about a dozen convex parts, which differ from it by a few percent of its size and may fill
  narrow notches. A fixed mesh keeps its triangles.
- **Rolling**: balls, cylinders and capsules roll smoothly at any speed, also as wheels on a hinge. So do compounds of them that share one
  axis, and cones on their sides. A frustum has 32 sides, so it loses speed. A hoop (a torus) is unreliable.
- **Pressing**: a motor that presses a body onto another one with far more than its weight needs a smaller step. The summary and a warning tell
  when joints or contacts add energy.
- **Machines**: a body with `end` takes its joints with it when it disappears. So a load that a
  joint connects to a small body becomes free at the `end` of that body: a latch, for a catapult or a crane. A slider with a motor can pull a
  rope, like a winch.
- **Fast bodies** do not pass through thin ones at any speed. Two bodies that are both fast may pass through each other.
- **Forces** of all kinds act as in Euler–Cromer: they are evaluated at the beginning of each step.
";

/// The documentation section on particles.
const PARTICLES: &str = "
## Particles

```toml
[simulation]
duration = 6
gravity = [0, -9.81, 0]

[emitter.fountain]                # drops
shape.sphere.radius = 0.01
from.disc = { location = [0, 0.1, 0], radius = 0.03 }
rate = 2000
start = -2                        # already running when the film begins
lifetime = \"uniform(0.9, 1.1)\"
spread = 8
speed = \"normal(5, 0.2)\"
color = [\"#ffffff\", \"#3366ff\"]

[body.wheel]
shape.cylinder = { radius = 0.2, height = 0.05 }
location = [1, 0.5, 0]
orientation = [90, 0, 0]
angular_velocity = [0, 0, 50]

[emitter.sparks]                  # from a spinning wheel
shape.sphere.radius = 0.004
from = { point = [0.2, 0, 0], body = \"wheel\" }
rate = 400
lifetime = 0.6
spread = 25
speed = \"uniform(0, 2)\"
color = [\"#fff0b0\", \"#ff7a1a\", \"#701005\"]
glow = 2
streak = 0.02
mass = 1e-6

[force.air.drag]
linear = 1e-6
on = [\"sparks\"]
```

A particle is a small ball. An emitter sends it out, and it dies at the end of its lifetime. Three things act on it: gravity, forces without
`on`, and forces that name its emitter in `on`. Springs and forces with `between` do not. It moves by the integrator and the timestep of the bodies.
Particles act neither on bodies nor on each other. They pass through bodies unless the emitter has `collides = true`. The energy balance, labels and
tables ignore them.

- **Emission**: `rate` emits one after another at even intervals, each at its exact time, also within a step. `burst` emits
  many at once, and again after `every`. With a `start` before 0, particles already exist when the run begins; bodies stand still until then.
- **Random values**: `speed` and `lifetime` may be formulas with `uniform`, `normal` and the time of emission `t`. Each particle gets its own
  random numbers. They depend only on the `seed`, the name of the emitter and the number of the particle, so a selection of frames
  shows the same particles as the whole film.
- **Moving emitters**: with `from.surface`, or with `body` beside a point, a disc or a box, particles start at the body's current position,
  and the velocity of that point of the body is added to theirs. `direction` is then in the axes of the body.
- **Collisions**: with `collides = true` and `simulation.contacts`, the ground and all colliding bodies stop the particles. Each is a ball
  of its `radius` without rotation. It bounces by `restitution`, slides and sticks by `friction`, and can rest on moving bodies.
  Its values combine with those of the body, as for two bodies. Between two frames, a body moves along a smooth curve. A particle emitted inside
  a body first passes out of it. A torus does not stop particles. With `event-driven` contacts, an emitter
  has at most 1,000 colliding particles at once; with `time-stepping`, the limit is that of other
  particles.
- **Looks**: `color` and `size` change in 32 steps from birth to death. A glowing particle casts no shadow and lights nothing: for that, add
  a `[light.NAME]`. Positions are written to a hundredth of the radius.
- **Limits**: 100,000 particles make a script of 4.5 MB, which POV-Ray parses in about half a second. The preview shows particles. `jabuka export
  SCENE -o FILE.csv --particles` writes a table of them. Exported models leave them out.
";

/// The documentation section on formulas, up to the generated list of functions.
const FORMULAS: &str = "
## Formulas

```toml
[variables]
r = 2.5
speed = \"sqrt(2*9.81*height)\"   # in any order
height = \"4*r\"

[body.ball]
shape.sphere.radius = \"r\"
location = [\"r*cos(rad(30))\", \"r*sin(rad(30))\", \"uniform(-1, 1)\"]
velocity = [\"if(r > 2, speed, 0)\", 0, 0]
```

A formula consists of numbers, the names of `[variables]`, constants, functions, parentheses and the following operators. The
operators are listed from the lowest precedence to the highest:

| operators | meaning |
| --- | --- |
| `or` | 1 if either side is not 0, else 0 |
| `and` | 1 if neither side is 0, else 0 |
| `not x` | 1 if x is 0, else 0 |
| `<` `<=` `>` `>=` `==` `!=` | 1 if true, else 0 |
| `x + y` `x - y` | sum, difference |
| `x * y` `x / y` `x % y` | product, quotient, and remainder with the sign of y: `-1 % 4` is 3 |
| `-x` `+x` | sign: `-x^2` is -(x^2) |
| `x ^ y` | power, right-associative: `2^3^2` is 2^9 |

A key for a whole number needs a formula with a whole value. A division by zero, or any other step with a non-finite
result, is an error at its position; `if`, `and` and `or` evaluate only what they need. `jabuka compile --set variables.r=3`
gives a variable another value.

A variable can have a slider on the page of `jabuka preview` and of the playground. `value` stands where the number would:

```toml
[variables]
angle = { value = 35, min = 5, max = 60, step = 1, unit = \"°\", title = \"upwards\" }

[body.ball]
shape.sphere.radius = 0.2
velocity = [\"5*cos(rad(angle))\", \"5*sin(rad(angle))\", 0]
```

Random numbers depend only on the `seed` of the scene and the path of their key, such as `body.ball.location[2]`. They are the
same on every run and machine, and do not change when you add another body.
";

/// The documentation section on repeated bodies, defaults and included files.
const COPIES: &str = "
## Many from few

```toml
[body.domino]                     # domino[0] to domino[499]
shape.box.size = [0.1, 0.8, 0.4]
repeat.curve.count = 500
repeat.curve.at = [\"(1 + 5*u)*cos(6*tau*u)\", 0, \"(1 + 5*u)*sin(6*tau*u)\"]

[body.brick]                      # brick[0,0] to brick[7,3]
shape.box.size = [1, 0.5, 0.5]
location = [\"-4 + (j % 2)/2\", 0.25, -9]
mass = \"1 + i/10\"
repeat.grid = { count = [8, 4], spacing = [1.02, 0.52] }

[body.ball]
shape.sphere.radius = \"uniform(0.05, 0.15)\"
location = [0, 5, 0]
repeat.scatter = { count = 100, within.sphere.radius = 2 }

[force.air.drag]
linear = 0.1
on = [\"ball\", \"brick[*,3]\", \"domino[0]\"]
```

A body with a `repeat` becomes several bodies, each named by the body's name and an index. Formulas of the body know the index: `i`, and in a
grid also `j` and `k`. The position in the arrangement is added to `location` and `orientation`, but not to the places of a `motion`: write
these with the index. In a list of bodies, the name alone means all copies, and `*` all of a row. In `between`, the name alone makes a chain
of springs from each copy to the next.

```toml
[body.hook]
repeat = 20
shape.sphere.radius = 0.02
location = [0, 1, \"0.15*i\"]
fixed = true

[body.bob]
repeat = 20
shape.sphere.radius = 0.06
location = [0, \"0.2 + 0.03*i\", \"0.15*i\"]

[joint.string.rod]                # string[0] to string[19]
between = [\"hook[i]\", \"bob[i]\"]

[force.neighbors.spring]          # neighbors[0] to neighbors[18]
between = [\"bob[i]\", \"bob[i+1]\"]
stiffness = \"10 + i\"
```

A force or a joint whose ends are named with `i` is repeated: `i` counts from 0 for as long as all named bodies exist.
`repeat = 5` makes five copies instead. An index is a formula: `bob[2*i+1]` takes every second bob, and `bob[count-1]` the last one, if
`count` is a variable.

Each copy has its own random numbers, independent of other copies and bodies. Scattered copies are placed one
after another, each at random until its bounding ball overlaps no earlier copy; other bodies are ignored.

A pyramid, or the pins of a bowling lane, have rows of 1, 2, 3, … copies. Copy `i` is in row `floor((sqrt(8*i + 1) - 1)/2)`:

```toml
[body.box]                        # box[0] at the top, box[1] and box[2] below it, and so on
repeat = 55                       # 1 + 2 + … + 10
shape.box.size = [0.4, 0.4, 0.4]
location = [
  \"0.42*(i - floor((sqrt(8*i + 1) - 1)/2)*(floor((sqrt(8*i + 1) - 1)/2) + 2)/2)\",
  \"0.2 + 0.4*(9 - floor((sqrt(8*i + 1) - 1)/2))\",
  0,
]
```

```toml
[defaults.body]
shape.sphere.radius = 0.2
material = \"brass\"

[body.left]
location = [-1, 0, 0]

[body.right]
location = [1, 0, 0]
shape.box.size = [0.4, 0.4, 0.4]
```

`[defaults.body]` gives defaults for missing keys of all bodies, key by key. A body's own key also replaces a default that excludes
it, as a box replaces a sphere. Formulas of the defaults are evaluated for each body.

`include = [\"room.toml\", \"lamps/desk.toml\"]` reads these files first. This file's own values override theirs. Their
`[defaults]` apply to all files. If two included files disagree, this file has to give the value. Paths of included files are relative to the file
that includes them, and stay inside the scene's folder without `--trust`. Other paths, such as those of `povray.assets`, are relative to the
folder of the scene in every file.
";

/// The documentation section on prescribed motion.
const MOTION: &str = "
## Prescribed motion

```toml
[body.crank]
shape.box.size = [1.0, 0.1, 0.1]
motion.formula.location = [\"0.5*cos(3*t)\", \"0.5*sin(3*t)\", 0]
motion.formula.orientation = [0, 0, \"deg(3*t)\"]

[body.lift]
shape.box.size = [1, 0.1, 1]
motion.keyframes.at = [
  { time = 0, location = [2, 0, 0] },
  { time = 2, location = [2, 3, 0] },
  { time = 3, orientation = [0, 90, 0] },
]

[camera]
location = [0, 2, 12]
follow = { body = \"lift\", distance = 9 }
orbit.period = 20
```

Formulas of a `motion`, of the camera and of lights know the time `t`, s. A motion can follow another body that moves by formulas: `crank.x + 1`.
Velocities are derived from the motion. A body with a motion acts on
others, for example by springs, and the work of its drive is booked. Its kinetic energy is part of `kinetic` and `energy`, but not of the drift, as its
drive gives it. The momentum of the scene does not contain its own.

A `motion.trajectory` is a CSV file with a row for each time and body. Its columns are `t` (or `time`), `body`, `x`, `y`, `z`, and optionally
`qx`, `qy`, `qz`, `qw` (a quaternion), `vx`, `vy`, `vz` and `wx`, `wy`, `wz` (in world axes). Units stand in brackets: `x [cm]`. `jabuka export`
writes the same table. So you can draw a run with other bodies, or draw the run of another program with jabuka. If the velocities contradict the
places, as in another unit, it is an error; `columns.velocity = []` leaves them out.
";

/// The documentation section on labels, up to the generated list of quantities.
const LABELS: &str = "
## Labels

```toml
[body.ball]
shape.sphere.radius = 0.2
velocity = [3, 4, 0]

[label.clock]
text = \"t = ${t:.2} s\"

[label.speed]
text = \"${ball.speed:.1} m/s, ${ball.speed*3.6:.0} km/h\"
corner = \"top-right\"

[label.height]
text = \"h = ${y:.1} m\"
body = \"ball\"
```

Between `${` and `}` stands a [formula](#formulas) of the current values and `[variables]`. After a colon, `.2` means two
decimals and `.2e` two decimals with a power of ten. The default is three significant digits, and all digits for a number of impacts. In a label at
a body, the names of that body's values need no prefix, and take precedence over variables of the same name; with `ghosts`, only these and `t` are
available, without those that need other bodies or contacts, such as `potential`. A value that is undefined, such as the speed of an absent body, is shown as `?`.
`output.decimal = \",\"` writes decimal commas in labels, plots, the grid and the scale bar.

**Units**: after the colon, a unit can stand, alone or behind the format: `${ball.speed:km/h}` and `${ball.speed:.1f km/h}`. The value is
converted, and the unit stands behind the number. It must fit the measure; a formula of measures has no unit that jabuka knows. Plots take
units, too: `y = \"ball.speed:km/h\"`.

**Copies**: `ball[0].x` belongs to one copy of a body with [`repeat`](#bodyname-repeat). `sum(…)`, `mean(…)`, `max(…)` and `min(…)` make one
value of many copies: `sum(gas.kinetic)`, `mean(gas[*].x)`, `max(brick[*,0].y)`. A formula can stand inside, also with other measures:
`sqrt(mean((gas.x - mean(gas.x))^2))`. Absent copies are left out. If all are absent, the sum is 0, and the others are undefined.

**Forces**: `force.air.x` is the force that `[force.air]` alone exerts on its body. If it acts on several bodies, name one:
`force.air.ball.x`. Fixed bodies feel no forces. `force.air.power` is its power on all its bodies together, the sum of F·v + τ·ω.

**Potential energy**: `ball.potential` is the body's share of the potential energy of all forces. Of an energy that two bodies have together, such as
that of a spring between them, each has half; beside a fixed or guided body or a fixed point, the other one has all of it. So the shares add up to `potential`.
`force.spring.potential` is the energy of one force, and `force.spring.ball.potential` the body's share of it.

Elsewhere, a variable of the scene hides a measure of the run with the same name. In the table, words in capitals stand for names: `BODY` and
`OTHER` for bodies, `NAME` for a joint, a force, an emitter or a mark. `jabuka list measures` prints it. A body with a
`motion.trajectory` also has the further columns of its file as measures: with a column `epot [eV]`, `${atom.epot:eV}` is its value, on a
straight line between two rows. A measure of the table has precedence over a column of the same name.

In the texts of labels and plots, `v_0` and `m/s^2` are subscripts and superscripts, as are `x_{max}` and `10^{-6}`, with any letters in braces. Without
braces, only a single letter has a subscript, so `my_ball` stays as it is. `**` around words makes them bold: `\"**Height**: ${ball.y:.1} m\"`. A backslash makes the sign itself: `'v\\_0'` in single quotes.

Texts are set in DejaVu Sans, which is placed beside the scripts. A label can have another TrueType font, with letters of one weight:
`font = \"Lato.ttf\"` is a file beside the scene.

`\\n` in double quotes begins a new line. A label in a corner that is wider than the picture is broken into lines at its spaces.
`corner = \"center\"` makes a title in large letters; with `until = 2`, it disappears after two seconds. Labels that are not visible need no
room, so others move into their places.

A label at a body is left out of pictures without the body. If it would cover an arrow or another
label, it moves to another side, or a little farther away. It hides the grid numbers that it would cover.

| name | meaning |
| --- | --- |
";

/// The documentation section on angles, distances and the texts of arrows.
const MARKS: &str = "
## Angles, distances, names of arrows

```toml
[simulation]
gravity = [0, -9.81, 0]

[body.bob]
shape.sphere.radius = 0.1
location = [1, 1, 0]
arrows.weight = { label = \"G\", components = [1, 1, 0], component_labels = [\"G₁\", \"G₂\"] }
arrows.velocity.label = \"v = ${speed:.1} m/s\"

[force.air.drag]
linear = 0.3
arrow.label = \"R\"

[joint.string.rod]
between = [[0, 2, 0], \"bob\"]

[angle.phi]
at = [0, 2, 0]
from = [0, -1, 0]
to = \"bob\"
text = \"φ = ${angle.phi:.0}°\"

[distance.h]
between = [[0, 0, 0], \"bob\"]
along = [0, 1, 0]
offset = [1.5, 0, 0]
```

An angle is an arc between two legs that begin at one point. A leg is a direction, or points to a body or a point, or along the velocity, acceleration or
force of a body. Without `axis`, the angle is that between the legs, from 0° to 180°. With `axis`, it counts counterclockwise about the axis, as seen
from the tip of the axis, from −180° to 180°. A distance is a dimension line. `offset` moves the line away from its ends, and `along` measures in one direction only. Without a
`text`, an angle shows its name (`alpha` as α), and a distance shows its length.

An area consists of the sectors that the line from `center` to `body` sweeps in equal times. `area.NAME` is the area of the last complete sector. A picture
shows the sectors of the last turn. If the center moves, the path counts relative to it.

`arrow` of a force draws this force alone at each of its bodies, beside the arrows of the body, which show sums. `label` writes a text at the tip of an arrow.
`components` draws the components of the vector along a direction and across it, too. The direction is given as a leg of an angle: `components = \"bob.velocity\"`
splits a force into those along the path and towards its center. Texts stand near what they name: they move a little aside for arrows and bodies, and never
cover each other if they can evade.
";
/// The documentation section on plots.
const PLOTS: &str = "
## Plots

```toml
[body.ball]
shape.sphere.radius = 0.2
velocity = [3, 4, 0]

[plot.energy]
y = [\"kinetic\", \"potential\", \"total\"]
side = \"right\"

[plot.path]
y = \"ball.y\"
x = \"ball.x\"
names = \"height\"
x_name = \"way\"
```

A plot draws [measures](#labels), or formulas of them, as curves: in each frame up to its time, with a dot at the present values. The axes
show the whole run from the first frame on. Where a value is undefined, as that of an absent body or the root of a negative number, the curve has a
gap. A unit stands at an axis if all of its curves are single measures of one unit; another one can be asked for, as in `y = \"ball.speed:km/h\"`. A curve has the color of the
body that its formula names, if it names only one. In runs of more than 600 frames, a curve is drawn through the lowest and highest values of neighboring
frames, so no peak is lost. `output.layout = \"shared\"` writes the curves once for all frames, which saves space in long runs.

```toml
[body.bob]
shape.sphere.radius = 0.2
velocity = [3, 0, 0]

[force.air.drag]
linear = 0.7

[plot.decay]
y = \"bob.speed\"
log = true
```

`log = true` makes the vertical axis logarithmic: a decay is a straight line. `log = \"x\"` and `log = \"xy\"` do so for the axis across, and for both: a power
of `x` is a straight line. A logarithmic axis has no place for zero and negative values. There, a curve has a gap, and a warning says how
many values are left out.

```toml
[body.atom]
shape.sphere.radius = 0.1
velocity = [\"normal(0, 2)\", \"normal(0, 2)\", \"normal(0, 2)\"]
repeat.grid = { count = [5, 5, 5], spacing = [1, 1, 1] }

[plot.energies]
bars = [\"kinetic\", \"potential\", \"total\"]

[plot.speeds]
histogram = \"atom.speed\"
bins = 12
side = \"right\"
```

`bars` draws the values of one moment as bars, with their names below. They begin at zero; negative values go down. `bars = \"atom.speed\"` of a repeated
body draws a bar for each copy, with its index below. `histogram` takes a formula that
has a value for each of several copies, as inside `sum(…)`. It divides the range from the lowest to the highest value of the run into equal bins, and
shows how many copies are in each bin at the moment of the picture. A value at the edge of two bins is in the upper one. The axes of both hold for
the whole run. In a run with more than 2 million values, the axis of a histogram is made from evenly chosen frames.

`legend = \"ends\"` writes the names of curves at their right ends. Names that are too near to each other move apart. If they have no room, or if a
curve ends far from the right edge, they stand above the plot, as without the key.

A plot in a corner stands in front of the bodies. Several plots at the same place stand below each other and share the height of the picture.
If words have too little room, the letters get smaller, and the longest words are cut. A plot that leaves the picture or covers another one
gets a warning, and so does a curve of which no picture shows a point. Beside a plot at a side, a camera that the scene neither places nor moves shows the bodies in the
rest of the picture. `jabuka export SCENE --plot NAME -o FILE.svg` draws the whole plot for paper; FILE.png and FILE.pdf do so, too. Bars are
those of the last moment. FILE.csv is a table of its values in each frame.
";

/// The description of what follows measures besides texts, plots and looks.
const FOLLOWING: &str = "
## Cameras, lights and SDL that follow measures

The measures of labels also move cameras and lights: in `location`, `look_at` and `angle` of a camera or a view, and in the `location` of a light.
They stand in formulas, as numbers and `t` do. In `povray.sdl`, `${…}` becomes the value of a formula in the script of each frame.

```toml
[body.ball]
shape.sphere.radius = 0.3
location = [0, 8, 0]
velocity = [2, 0, 0]

[camera]
location = [\"ball.x\", 4, 12]
look_at = [\"ball.x\", \"max(ball.y, 1)\", 0]
angle = \"40 + 2*ball.speed\"

[light.lamp]
point.location = [\"ball.x\", \"ball.y + 3\", 5]

[povray]
sdl = \"sphere { <${ball.x}, ${ball.y}, 0>, 0.31 pigment { rgbt <1, 0, 0, ${1/(1 + ball.speed)}> } }\"
```

A value has the unit of its measure; another one may be asked for, as in a label: `${ball.speed:km/h}`. Lengths in SDL are in POV-Ray's units: one unit is
1 m, unless the scene is very small or very large (`povray.unit`). SDL with values stands in each script, before the bodies. Materials stand before it,
so they cannot use what it declares; `sdl_before` and `sdl_after` of a body can. While a body is absent, its measures have no value, and a script that
needs one is an error.
";

/// The documentation page under construction.
struct Page {
    text: String,
    /// The tables that have a section on the page, with the titles of the sections.
    sections: Vec<(&'static TableSpec, String)>,
}

impl Page {
    fn section(&mut self, path: &str, table: &'static TableSpec) {
        let title = if path.is_empty() { "The scene".to_owned() } else { format!("`{path}`") };
        let _ = write!(self.text, "\n## {title}\n\n");
        self.sections.push((table, title));
        match &table.rule {
            Rule::Any => {}
            Rule::AtMostOne(groups) => {
                for names in *groups {
                    let _ = writeln!(self.text, "At most one of {}.", quoted(names));
                }
                self.text.push('\n');
            }
            Rule::ExactlyOne(names) => {
                let _ = write!(self.text, "Exactly one of {}.\n\n", quoted(names));
            }
        }
        self.text.push_str("| key | value | unit | default | meaning |\n| --- | --- | --- | --- | --- |\n");
        table.keys().for_each(|key| self.row(key));
        for key in table.keys {
            self.inner(path, key.name, &key.kind);
        }
    }

    fn formulas(&mut self) {
        let _ = write!(self.text, "{FORMULAS}\n| constant | meaning |\n| --- | --- |\n");
        for (name, _, meaning) in CONSTANTS {
            let _ = writeln!(self.text, "| `{name}` | {meaning} |");
        }
        self.text.push_str("\n| function | meaning |\n| --- | --- |\n");
        for function in FUNCTIONS {
            let _ = writeln!(self.text, "| `{}` | {} |", function.usage(), function.meaning);
        }
    }

    fn labels(&mut self) {
        self.text.push_str(LABELS);
        for ListedMeasure { name, unit, meaning } in Measure::listed() {
            let _ = writeln!(self.text, "| `{name}` | {unit} | {meaning} |");
        }
        self.text.push_str(PLOTS);
        self.text.push_str(FOLLOWING);
        self.text.push_str(MARKS);
    }

    fn row(&mut self, key: &KeySpec) {
        let KeySpec { name, kind, unit, default, meaning, required, .. } = key;
        let default = if *required { "**required**".to_owned() } else { default.in_words() };
        let value = self.in_short(kind).replace('|', "\\|");
        let _ = writeln!(self.text, "| `{name}` | {value} | {unit} | {default} | {meaning} |");
    }

    /// Returns the title of a table's section. `None` if the page has no section for the table yet.
    fn title(&self, table: &TableSpec) -> Option<&str> {
        let written = self.sections.iter().find(|(spec, _)| std::ptr::eq(*spec, table));
        written.map(|(_, title)| title.as_str())
    }

    fn in_short(&self, kind: &Kind) -> String {
        match kind {
            Kind::Table(table) => match self.title(table) {
                Some(title) => format!("as {title}"),
                None => "table".to_owned(),
            },
            Kind::Named(_) => "tables with names".to_owned(),
            Kind::Partial(table) => match self.title(table) {
                Some(title) => format!("any keys of {title}"),
                None => "table".to_owned(),
            },
            Kind::Either(kinds) => {
                kinds.iter().map(|kind| self.in_short(kind)).collect::<Vec<_>>().join(", or ")
            }
            kind => kind.in_words(),
        }
    }

    fn inner(&mut self, path: &str, name: &str, kind: &'static Kind) {
        match kind {
            Kind::Table(table) if self.title(table).is_some() => {}
            Kind::Named(table) | Kind::Variables(table) => self.section(&format!("[{name}.NAME]"), table),
            Kind::Table(table) if path.is_empty() => self.section(&format!("[{name}]"), table),
            Kind::Table(table) => {
                let dot = if path.ends_with(']') { " " } else { "." };
                self.section(&format!("{path}{dot}{name}"), table);
            }
            Kind::Either(kinds) => kinds.iter().for_each(|kind| self.inner(path, name, kind)),
            Kind::List { of, .. } => self.inner(path, name, of),
            _ => {}
        }
    }
}
