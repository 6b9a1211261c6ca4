//! Explains the code of each diagnostic, with an example that causes the error and a corrected one.

use crate::diagnostic::{Code, nearest};

/// The explanation of one code: the text of its file in `explanations/`.
#[derive(Clone, Copy, Debug)]
pub struct Explanation {
    /// The code of the diagnostic.
    pub code: Code,
}

/// Returns the explanations of all codes, in the order of the codes.
pub fn explanations() -> impl ExactSizeIterator<Item = Explanation> {
    Code::ALL.iter().map(|&code| Explanation { code })
}

impl Explanation {
    /// Returns the explanation of the code with this name.
    ///
    /// # Errors
    /// If no code has this name. The error is the most similar name, if one is similar enough.
    pub fn of(name: &str) -> Result<Explanation, Option<&'static str>> {
        match Code::named(name) {
            Some(code) => Ok(Explanation { code }),
            None => Err(nearest(name, Code::ALL.iter().map(|code| code.name()))),
        }
    }

    /// Returns the meaning of the code, in one line.
    pub fn title(&self) -> &'static str {
        self.code.explanation().lines().next().unwrap_or_default().trim_start_matches("# ")
    }

    /// Returns the example that causes the error: a scene, or shell commands, each after the prompt `$ `.
    pub fn wrong(&self) -> String {
        self.example("\nWrong:\n")
    }

    /// Returns the corrected example, which does not cause the error.
    pub fn right(&self) -> String {
        self.example("\nRight:\n")
    }

    /// Returns the indented lines below a heading of the explanation, without their indentation.
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
