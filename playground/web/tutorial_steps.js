// The steps of the tutorial. Each has a title, what it says (paragraphs and code), a check (`done`), and a word for who has done it. `mend` does it
// in the text.

const highest = (path) => Math.max(...path.map(([, y]) => y));

/** True if a body comes down and rises again by at least `by` meters. */
function rebounds(path, by) {
  let lowest = Infinity;
  return path.some(([, y]) => {
    lowest = Math.min(lowest, y);
    return y > lowest + by && lowest < path[0][1] - by;
  });
}

/** Inserts lines at the end of the table `[body.ball]`, or replaces the line that begins with the same key. */
function inBall(text, line) {
  const key = line.split(" ", 1)[0];
  const known = new RegExp(`^${key} .*$`, "m");
  return known.test(text) ? text.replace(known, line) : text.replace(/(\[body\.ball\]\n(?:[^[\n].*\n)*)/, `$1${line}\n`);
}

const lasting = (text, duration) => text.replace(/^duration = [\d.]+/m, `duration = ${duration}`);
const touching = (text) => (text.includes("contacts =") ? text : text.replace(/^gravity .*\n/m, '$&contacts = "event-driven"\n'));

const FIRST = `[simulation]
duration = 0.7                 # s
gravity = [0.0, -9.81, 0.0]    # m/s²

[body.ball]
shape.sphere.radius = 0.5      # m
location = [0.0, 3.0, 0.0]     # m: to the right, up, towards you
`;

const SLIDER = '[variables]\nup = { value = 9, min = 0, max = 12, step = 0.1, unit = "m/s" }\n\n';

export const STEPS = [
  {
    title: "A ball falls",
    scene: FIRST,
    says: [
      "The text below describes what you see: a ball of half a meter, 3 m up, which gravity pulls down. All that the text leaves out, such as floor and light, has a default.",
      "Press the triangle under the picture, or the key P outside of the text, and see the ball fall.",
    ],
    done: ({ frame }) => frame > 5,
    well: "It falls 2.4 m in 0.7 s. There is no air.",
  },
  {
    title: "Throw it",
    says: ["Give the ball a velocity. Add this line to the end of [body.ball]:", { code: "velocity = [4.0, 9.0, 0.0]     # m/s" }, "Then give it time: change the duration to 2.0. The picture changes while you type."],
    mend: (text) => inBall(lasting(text, "2.0"), "velocity = [4.0, 9.0, 0.0]     # m/s"),
    done: ({ path }) => path("ball").at(-1)?.[0] > 7,
    well: "It flies to the right and up, and the camera sees the whole flight.",
  },
  {
    title: "Make a mistake",
    says: [
      "Everybody makes mistakes. Write velocty instead of velocity, and see what happens: the word is underlined, and the last good motion stays.",
      "Now put the pointer on the word, and click the button that mends it.",
    ],
    done: ({ problem, memory }) => {
      memory.hadOne ||= problem !== null;
      return memory.hadOne && problem === null;
    },
    well: "Errors say what was expected. Ctrl-Z takes back any change.",
  },
  {
    title: "Let it bounce",
    says: [
      "Bodies pass through each other and through the floor until the scene asks for contacts. Add this line to the end of [simulation], and change the duration to 4.0:",
      { code: 'contacts = "event-driven"' },
      "And this one to the end of [body.ball]. The ball then keeps 80 % of its speed at each impact:", { code: "restitution = 0.8" },
    ],
    mend: (text) => inBall(touching(lasting(text, "4.0")), "restitution = 0.8"),
    done: ({ path }) => rebounds(path("ball"), 0.2),
    well: "It bounces, each time lower.",
  },
  {
    title: "A slider",
    says: [
      "A variable can have a slider. Put these lines at the very beginning of the text:", { code: SLIDER.trim() },
      'Then use it: write "up" with its quotes in place of 9.0 in the velocity. Move the slider beside the picture; the text follows it.',
    ],
    mend: (text) => inBall(/\[variables\]/.test(text) ? text : SLIDER + text, 'velocity = [4.0, "up", 0.0]     # m/s'),
    done: ({ sliders, path, memory }) => {
      if (!sliders.length || !path("ball").length) return false;
      memory.first ??= highest(path("ball"));
      return Math.abs(highest(path("ball")) - memory.first) > 0.01;
    },
    well: "Any number may be a formula in quotes, such as \"2*up\".",
  },
  {
    title: "Find a value",
    says: ["How fast must the ball start so that its center comes up to 6 m, to within 10 cm? Move the slider, and click a point of the plot below or the ball to read its location."],
    done: ({ path }) => Math.abs(highest(path("ball")) - 6) < 0.1,
    well: "Energy says so, too: ½ v² = g h with h = 3 m gives v = √(2 · 9.81 · 3) = 7.7 m/s.",
  },
  {
    title: "Look at a body",
    says: ["Click the ball. Its values at this moment appear at the right. The arrow keys go a frame on or back, and the picture can be turned by dragging it."],
    done: ({ chosen }) => chosen === "ball",
    well: "The plots below can show its location, velocity and force, too.",
  },
  {
    title: "Is it right?",
    says: [
      "A computer advances in small steps, and each makes a small error. The line under the title says how much energy was gained or lost: the drift.",
      "Choose rk4 at \"Compare with\" at the right. The page then shows both runs, and how far apart they are.",
    ],
    done: ({ isCompared }) => isCompared,
    well: "Where methods agree, the result is right. Where they differ, take a smaller step.",
  },
  {
    title: "Send it to someone",
    says: ["Press \"Copy link\". The link holds the whole scene; who opens it sees the same motion and can change it. Nothing is sent anywhere else."],
    done: ({ hash }) => hash.startsWith("#scene="),
    well: "That was all. Examples has many scenes to change, and jabuka itself makes films of them.",
  },
];
