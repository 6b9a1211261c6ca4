//! What every code of a diagnostic means, with an example that gets it and one that does not.

use crate::diagnostic::{Code, nearest};

/// What one code means: the text of its file in `explanations/`.
#[derive(Clone, Copy, Debug)]
pub struct Explanation {
    /// The code.
    pub code: Code,
}

/// All of them, in the order of the codes.
pub fn explanations() -> impl ExactSizeIterator<Item = Explanation> {
    Code::ALL.iter().map(|&code| Explanation { code })
}

impl Explanation {
    /// The explanation of a code, by its name.
    ///
    /// # Errors
    /// The nearest code that there is, if one is near.
    pub fn of(name: &str) -> Result<Explanation, Option<&'static str>> {
        match Code::named(name) {
            Some(code) => Ok(Explanation { code }),
            None => Err(nearest(name, Code::ALL.iter().map(|code| code.name()))),
        }
    }

    /// What it means, in one line.
    pub fn title(&self) -> &'static str {
        self.code.explanation().lines().next().unwrap_or_default().trim_start_matches("# ")
    }

    /// The example that gets the code: a scene, or commands after `$ `.
    pub fn wrong(&self) -> String {
        self.example("\nWrong:\n")
    }

    /// The example that does not get it.
    pub fn right(&self) -> String {
        self.example("\nRight:\n")
    }

    /// The indented lines below a heading.
    fn example(&self, heading: &str) -> String {
        let after = self.code.explanation().split_once(heading).map_or("", |(_, after)| after);
        let lines = after.lines().take_while(|line| line.is_empty() || line.starts_with("    "));
        let text: String = lines.map(|line| format!("{}\n", line.trim_start_matches("    "))).collect();
        text.trim_matches('\n').to_owned()
    }
}

impl std::fmt::Display for Explanation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let body = self.code.explanation().split_once('\n').map_or("", |(_, body)| body);
        writeln!(f, "{}: {}", self.code, self.title())?;
        f.write_str(body)
    }
}
