//! The description of the language as a page of the documentation.

use std::fmt::Write as _;

use super::{Key, Kind, Rule, SCENE, TableSpec, quoted};
use crate::scene::expression::{CONSTANTS, FUNCTIONS};
use crate::scene::{BodyMeasure, JointMeasure, RunMeasure};

/// All keys of the scene language, as Markdown.
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
    page.text.push_str(MANY);
    page.text.push_str(MOTION);
    page.text.push_str(CONTACTS);
    page.text.push_str(PARTICLES);
    page.labels();
    page.text
}

/// The section on contacts.
const CONTACTS: &str = "
## Contacts

```toml
[simulation]
duration = 4
gravity = [0, -9.81, 0]
contacts = \"event-driven\"
integrator = \"velocity-verlet\"

[body.ball]
shape.sphere.radius = 0.1
location = [0, 2, 0]
restitution = 0.8

[environment.ground]
friction = 0.3

[label.count]
text = \"${impacts} impacts, ${ball.impacts.ground} with the ground\"
```

Without `contacts`, bodies pass through each other, and the first two that do so get a warning. With `\"event-driven\"`, each impact has its own
time, found within the step. Newton's law gives the rebound, Coulomb's law the friction. A body whose rebound nobody could see comes to rest, and then
sticks, slides or rolls as the forces on it ask.

- **What collides**: all bodies but axes. Bodies that a joint holds together pass through each other unless the joint says
  `collides = true`; so do bodies with the same `collision_group`, and a body with `collides = false` passes through everything. Contacts
  of a torus cannot be computed; build it as a `compound`.
- **The ground** lies at height 0 if the scene does not say where. It stops bodies, and has `restitution`, `friction` and
  `rolling_friction` of its own. With `ground = false`, and in an environment without one, no ground stops them.
- **Two surfaces**: what one body does not say, the other one says. Where both do, the larger restitution, the geometric mean of the
  frictions and the larger rolling friction count. Where neither does, these are 0, 0.5 and 0 m.
- **Impacts at the same time** happen one after another, in the order of their approach speeds, the fastest first. Of equal ones, that of
  the bodies that stand first in the scene comes first. In a Newton's cradle, so as many balls leave as arrive.
- **Too many events**: some bodies hit, grip and release each other again and again within one step, as in a chain that falls on the floor.
  Time-stepping (Moreau's scheme) then advances these bodies to the end of the step or for some steps more. All impacts of a part of a step
  happen at once there, by Poisson's law, and what would rebound only for a moment does not rebound. The energy stays balanced.
- **Heaps**: where more than six pairs of bodies touch and some begin to slide or part, time-stepping advances them until they rest, and with
  them what may hit them within a step.
- **At rest**: bodies that have rested on each other for eight steps are held, until something touches them or a force on them changes. So
  a heap at rest costs nothing.
- **Integrators** of first order (`euler-cromer`, `explicit-euler`) are only as exact at impacts as between them; a warning says by how much
  the energy is wrong. Take `velocity-verlet` or `rk4`.
- **Energy**: what impacts and friction take are the accounts `impacts` and `friction` of the balance; neither is part of the drift.
- **To see it**: `arrows.weight`, `arrows.normal` and `arrows.friction` of a body show the forces on it from where they act. `impacts`
  counts in labels, and `jabuka export SCENE --events FILE.csv` writes a row for each impact.

### Many bodies: time stepping

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

With `contacts = \"time-stepping\"`, all contacts of a step are solved together. A step costs about as much as there are contacts, so piles, towers and
machines of thousands of bodies can be simulated. All keys mean the same as in the other scheme. Choose by what the scene is about:

| | `event-driven` | `time-stepping` |
| --- | --- | --- |
| bodies in contact at the same time | tens | tens of thousands |
| a rebound with restitution 1 | keeps its height | loses height; a warning says how much |
| a touching Newton's cradle | as many balls leave as arrive | the balls swing together |
| resting bodies | touch exactly | sink into each other by up to a percent of their thickness |
| integrators | any that keeps joints | `euler-cromer` |
| joints | all, exact to rounding | `ball`, `hinge`, `slider`, `fixed`, `rod`, `rope`; they give way a little |
| forces and torques of joints, in labels, arrows and tables | yes | refused |
| a motor with `angle` or `position` | exact, or with a `stiffness` | with a `stiffness` |
| torus | refused | a ring of capsules |
| rolling friction | yes | refused |

- **Energy**: what contacts, joints and motors take and give is booked, and is no part of the drift. The drift is relative to the largest kinetic
  energy, so it may be large where bodies only settle: they hardly move.
- **The step**: accuracy follows from `step`. Contacts are as stiff as the step allows, so half the step makes piles sink a quarter as deep. Where the scene
  does not say a step, it is 1/240 s, or so short that the thinnest body sinks in by at most 3 % of its thickness under ten times its weight: 1/480 s for
  10 cm, 1/1920 s for 1 cm.
- **Shapes**: a frustum is a hull with 32 sides, a torus a ring of capsules, off by at most 1 % of its tube. A mesh that moves is its convex hull, if it is
  convex, and is made of convex parts otherwise; one that does not move is its triangles.
- **Fast bodies** do not pass through thin ones, however fast they are. Of two bodies that are both fast, one may pass through the other.
- **Forces** of all kinds act as in Euler–Cromer: they are evaluated at the beginning of each step.
";

/// The section on particles.
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
start = -2                        # it runs already when the film begins
lifetime = \"uniform(0.9, 1.1)\"
spread = 8
speed = \"normal(5, 0.2)\"
color = [\"#ffffff\", \"#3366ff\"]

[body.wheel]
shape.cylinder = { radius = 0.2, height = 0.05 }
location = [1, 0.5, 0]
orientation = [90, 0, 0]
angular_velocity = [0, 0, 50]

[emitter.sparks]                  # from a wheel that turns
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

A particle is a small ball that an emitter sends out and that dies some time later. Three things act on it: gravity, forces without
`on`, and forces that name its emitter in `on`. Springs and forces with `between` do not. It moves by the integrator and the timestep of the bodies. Particles act neither on
bodies nor on each other. They pass through bodies unless the emitter says `collides = true`. They have no part in the energy balance, in labels or in tables.

- **Births**: `rate` sends out one after another at even intervals, each at its exact time, also between two steps. `burst` sends out
  many at once, and again after `every`. With a `start` before 0, particles are there when the run begins; bodies stand still until then.
- **Each its own**: `speed` and `lifetime` may be formulas with `uniform` and `normal`, which give each particle other numbers, and of the
  time of its birth `t`. They follow from the `seed`, the name of the emitter and the number of the particle alone: a selection of frames
  shows the same particles as the whole film.
- **From a body**: with `from.surface`, or `body` beside a point, a disc or a box, they leave from where the body is, and have the
  velocity of that point of it on top. `direction` is then in the axes of the body.
- **Collisions**: with `collides = true` and `simulation.contacts`, the ground and all bodies that collide stop the particles. Each is a ball
  of its `radius` that does not turn. It bounces by `restitution`, slides and sticks by `friction`, and rests on what moves.
  Values mix with those of the body as between two bodies. Between two frames, a body moves along a smooth curve. What begins inside
  a body passes out of it first. A torus does not stop particles. With `event-driven` contacts, an emitter
  has at most 1,000 particles at once that collide; with `time-stepping`, as many as any other.
- **Looks**: `color` and `size` go from birth to death in 32 steps. What glows casts no shadow; it does not light other things: that takes
  a `[light.NAME]`. Places are written to a hundredth of the radius.
- **Many**: 100,000 particles make a script of 4.5 MB, which POV-Ray parses in about half a second. The preview shows them. `jabuka export
  SCENE -o FILE.csv --particles` writes a table of them. Models leave them out.
";

/// The section on formulas, before the list of functions.
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

A formula is made of numbers, the names of `[variables]`, constants, functions and parentheses, and of these operators, from
those that bind least to those that bind most:

| operators | meaning |
| --- | --- |
| `or` | 1 where one of the two is not 0, else 0 |
| `and` | 1 where neither of the two is 0, else 0 |
| `not x` | 1 where x is 0, else 0 |
| `<` `<=` `>` `>=` `==` `!=` | 1 where it holds, else 0 |
| `x + y` `x - y` | sum, difference |
| `x * y` `x / y` `x % y` | product, quotient, and the rest, with the sign of y: `-1 % 4` is 3 |
| `-x` `+x` | signs: `-x^2` is -(x^2) |
| `x ^ y` | power, from the right: `2^3^2` is 2^9 |

A key that wants a whole number wants a formula with a whole value. A division by zero, and any other step that gives no finite
number, is an error at its place; of `if`, `and` and `or` only what is needed is computed. `jabuka compile --set variables.r=3`
gives a variable another value.

Random numbers follow from the `seed` of the scene and the place where they stand, such as `body.ball.location[2]`: they are the
same on every run and machine, and another body changes none of them.
";

/// The section on scenes of many bodies and several files.
const MANY: &str = "
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

A body with a `repeat` is as many bodies, which are called by its name and their index. Its formulas know the index: `i`, and in a
grid also `j` and `k`. How the copies stand comes on top of their `location` and orientation. Where a list wants bodies, the
name alone means all copies, and `*` all of a row; in `between`, a spring goes from each to the next.

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

Name the ends of a force or a joint with `i`, and it is repeated: `i` counts from 0 for as long as all named bodies exist.
`repeat = 5` makes five copies instead. An index is a formula: `bob[2*i+1]` takes every second bob, and `bob[count-1]` the last one, if
`count` is a variable.

A copy has random numbers of its own, which another copy or another body does not change. Scattered copies are placed one
after another, each at random until the ball around it overlaps none of those before it; other bodies are not looked at.

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

`[defaults.body]` gives defaults for missing keys of all bodies, key by key. A body's own key also replaces a default that cannot
stand beside it, as a box replaces a sphere. Formulas of the defaults are evaluated for each body.

`include = [\"room.toml\", \"lamps/desk.toml\"]` reads these files first. This file's own values override theirs, also in `[defaults]`, which all files
share; if two included files disagree, this file has to give the value. Their names
start from the folder of the file that they stand in, and stay in that of the scene without `--trust`. Other paths, as those of
`povray.assets`, start from the folder of the scene in every file.
";

/// The section on given motion.
const MOTION: &str = "
## Motion that is given

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

Formulas of a `motion`, of the camera and of lights know the time `t`, s. Velocities follow from the motion; what such a body does to
others, by springs say, counts, and so does the work of what guides it. Its kinetic energy and its momentum do not.

A `motion.trajectory` is a CSV file with a row for each time and body: the columns `t` (or `time`), `body`, `x`, `y`, `z`, and, if they are there,
`qx`, `qy`, `qz`, `qw` (a quaternion), `vx`, `vy`, `vz` and `wx`, `wy`, `wz` (in world axes). Units stand in brackets: `x [cm]`. `jabuka export`
writes the same table, so a run can be drawn with other bodies, and the run of any other program with jabuka.
";

/// The section on labels, before the list of names.
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

Between `${` and `}` stands a [formula](#formulas) over the numbers of the moment and `[variables]`. Behind a colon, `.2` is two
decimals, `.2e` two decimals and a power of ten; without it, three digits are shown, and all digits of a number of impacts. A label beside a body knows the numbers of
that body also without its name, and they come before variables of the same name; one with `ghosts` knows these and `t` alone.

A label beside a body is left out of pictures that do not show the body. Where it would lie on an arrow or on another
label, it stands on another side, or farther away. Numbers of a grid that a label would cover are left out.

| name | meaning |
| --- | --- |
";

/// The page as far as it is written.
struct Page {
    text: String,
    /// The tables that have a section, each with its title.
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
        self.text
            .push_str("| key | value | unit | without it | meaning |\n| --- | --- | --- | --- | --- |\n");
        table.keys.iter().for_each(|key| self.row(key));
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
        for (name, _, what) in RunMeasure::ALL {
            let _ = writeln!(self.text, "| `{name}` | {what} |");
        }
        for (name, _, what) in BodyMeasure::ALL {
            let _ = writeln!(self.text, "| `ball.{name}` | {what} |");
        }
        for (name, _, what) in JointMeasure::ALL {
            let _ = writeln!(self.text, "| `{name}` | {what} |");
        }
    }

    fn row(&mut self, key: &Key) {
        let Key { name, kind, unit, default, meaning, required, .. } = key;
        let default = if *required { "**must be there**".to_owned() } else { default.in_words() };
        let value = self.in_short(kind).replace('|', "\\|");
        let _ = writeln!(self.text, "| `{name}` | {value} | {unit} | {default} | {meaning} |");
    }

    /// The title of the section of a table, if it has been written.
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
            Kind::Named(table) => self.section(&format!("[{name}.NAME]"), table),
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
