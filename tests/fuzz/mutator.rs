//! Makes inputs that are almost valid, by random changes to texts and files of the project.

/// A random number generator with the same sequence on every machine. Source: G. L. Steele, D. Lea, C. H. Flood, *Fast splittable
/// pseudorandom number generators*, OOPSLA 2014 (SplitMix64).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        Random(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// Returns a random number below a limit; 0 if the limit is 0.
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        usize::try_from(self.next() % (limit.max(1) as u64)).unwrap()
    }

    pub(crate) fn choose<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.below(all.len())]
    }
}

/// Fragments that often break parsers: extreme numbers, characters of several bytes, keywords and punctuation of the languages that jabuka
/// reads.
const TOKENS: [&str; 69] = [
    "0",
    "-1",
    "1e308",
    "-1e999",
    "1e-320",
    "nan",
    "inf",
    "9223372036854775808",
    "0x10",
    "1_000",
    "\"",
    "'''",
    "\\",
    "\\u0000",
    "\n",
    "\r\n",
    "\t",
    "\u{0}",
    "·",
    "π.x",
    "−1",
    "é",
    "𝕏",
    "\u{202e}",
    "[",
    "]",
    "[[",
    "{",
    "}",
    "=",
    ".",
    ",",
    "#",
    "#end",
    "#macro A()",
    "#include \"x.inc\"",
    "include",
    "/*",
    "*/",
    "//",
    "${",
    "}",
    "${ball.x}",
    "sin(",
    ")",
    "^",
    "t",
    "i",
    "uniform(0,1)",
    "\nrepeat = 3\n",
    "repeat = 500000",
    "\nrepeat = 20000\n",
    "\nrepeat.grid = { count = [70, 70], spacing = 1 }\n",
    "\nduration = 9999\n",
    "\nghosts.every = 1e-3\n",
    "\n[force.f.gravitation]\n",
    "[body.x]",
    "shape.sphere.radius",
    "f 1 2 3",
    "v 1 2 3",
    "vn nan",
    "solid",
    "endfacet",
    "t,x,y,z",
    "\u{feff}",
    "save_file",
    "between = ['a[i]', 'b']",
    "Infinity",
    "e",
];

/// Changes an input at one to eight random places, and returns the result. Some changes insert a part of `other`.
pub(crate) fn mutate(random: &mut Random, input: &[u8], other: &[u8]) -> Vec<u8> {
    let mut bytes = input.to_vec();
    for _ in 0..=random.below(8) {
        let at = random.below(bytes.len() + 1);
        let end = (at + random.below(40)).min(bytes.len());
        match random.below(7) {
            0 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let copy = bytes[at..end].to_vec();
                let to = random.below(bytes.len() + 1);
                bytes.splice(to..to, copy);
            }
            3 => {
                let from = random.below(other.len());
                let piece = &other[from..(from + random.below(200)).min(other.len())];
                bytes.splice(at..at, piece.iter().copied());
            }
            4 => drop(bytes.splice(at..end, random.choose(&TOKENS).bytes())),
            5 => bytes.truncate(at.max(1)),
            _ => drop(bytes.splice(at..at, random.choose(&TOKENS).bytes())),
        }
    }
    bytes
}

/// Changes a text at random places like [`mutate`], and returns valid UTF-8.
pub(crate) fn mutate_text(random: &mut Random, input: &str, other: &str) -> String {
    String::from_utf8_lossy(&mutate(random, input.as_bytes(), other.as_bytes())).into_owned()
}

/// Values of several types, as a user may write them for any key.
const VALUES: [&str; 16] = [
    "1",
    "-2.5",
    "0",
    "true",
    "\"2 m\"",
    "\"ball\"",
    "\"red\"",
    "[0, 1, 0]",
    "[1]",
    "[1, 2]",
    "{ axis = [0, 1, 0] }",
    "{}",
    "\"1 + \"",
    "\"x\"",
    "[[0, 0, 0], \"ball\"]",
    "\"euler\"",
];

/// Changes one to three lines of a scene: keys, values, headers and the order of lines. Most results are valid TOML, with keys that belong
/// elsewhere, words of other programs (`words`), values of other types and missing or repeated lines.
pub(crate) fn mutate_lines(random: &mut Random, text: &str, other: &str, words: &[&str]) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let others: Vec<&str> = other.lines().collect();
    for _ in 0..=random.below(3) {
        if lines.is_empty() {
            lines.push(String::new());
        }
        let at = random.below(lines.len());
        let word = *random.choose(words);
        match random.below(10) {
            0 => drop(lines.remove(at)),
            1 => {
                let line = lines.remove(at);
                lines.insert(random.below(lines.len() + 1), line);
            }
            2 if !others.is_empty() => lines.insert(at, (*random.choose(&others)).to_owned()),
            3 => lines.insert(at, format!("{word} = {}", random.choose(&VALUES))),
            4 | 5 => {
                let value = *random.choose(&VALUES);
                lines[at] =
                    lines[at].split_once('=').map_or(String::new(), |(key, _)| format!("{key}= {value}"));
            }
            6 | 7 => {
                let rest = lines[at].split_once('=').map(|(_, rest)| format!("{word} ={rest}"));
                lines[at] = rest.unwrap_or_else(|| format!("[{word}]"));
            }
            8 => {
                let parts: Vec<&str> = lines[at].split('.').collect();
                let gone = random.below(parts.len());
                let kept = parts.iter().enumerate().filter(|(number, _)| *number != gone);
                lines[at] = kept.map(|(_, part)| *part).collect::<Vec<_>>().join(".");
            }
            _ => lines[at] = lines[at].replace('[', "[[").replace(']', "]]"),
        }
    }
    lines.join("\n") + "\n"
}
