//! What every code of a diagnostic means, with an example that gets it and one that does not.
//!
//! The texts are the files of `explanations/`, one for each code; `build.rs` makes the table of them.

use crate::diagnostic::nearest;

/// What one code means.
#[derive(Debug)]
pub struct Explanation {
    /// The code: `unknown-key`.
    pub code: &'static str,
    /// The file: a title, some sentences, and examples after `Wrong:` and `Right:`.
    text: &'static str,
}

/// All of them, in the order of the codes.
pub static EXPLANATIONS: &[Explanation] = include!(concat!(env!("OUT_DIR"), "/explanations.rs"));

impl Explanation {
    /// The explanation of a code.
    ///
    /// # Errors
    /// The nearest code that there is, if one is near.
    pub fn of(code: &str) -> Result<&'static Explanation, Option<&'static str>> {
        let found = EXPLANATIONS.iter().find(|explanation| explanation.code == code);
        found.ok_or_else(|| nearest(code, EXPLANATIONS.iter().map(|explanation| explanation.code)))
    }

    /// What it means, in one line.
    pub fn title(&self) -> &'static str {
        self.text.lines().next().unwrap_or_default().trim_start_matches("# ")
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
        let after = self.text.split_once(heading).map_or("", |(_, after)| after);
        let lines = after.lines().take_while(|line| line.is_empty() || line.starts_with("    "));
        let text: String = lines.map(|line| format!("{}\n", line.trim_start_matches("    "))).collect();
        text.trim_matches('\n').to_owned()
    }
}

impl std::fmt::Display for Explanation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let body = self.text.split_once('\n').map_or("", |(_, body)| body);
        writeln!(f, "{}: {}", self.code, self.title())?;
        f.write_str(body)
    }
}
