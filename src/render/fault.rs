//! The failure of a single frame, as found in POV-Ray's messages.

use std::fmt;
use std::path::{Path, PathBuf};

use super::PovRay;
use crate::diagnostic::{Code, Diagnostic, Report, Span};
use crate::system;

/// The failure of one frame: POV-Ray's message, with the line and body that it is about. Other frames may still succeed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The number of the frame.
    pub frame: usize,
    /// The path of the frame's script.
    pub script: PathBuf,
    /// The line of the script where POV-Ray stopped, from 1. `None` if the error is not in the script.
    pub line: Option<usize>,
    /// The name of the body that the line draws.
    pub body: Option<String>,
    /// POV-Ray's error message.
    pub message: String,
    /// True if the sandbox denied access to a file.
    pub outside: bool,
}

impl Fault {
    /// Finds the error message, the line and the body in POV-Ray's output (`said`) about a script.
    pub(super) fn parse(frame: usize, script: PathBuf, said: &str, povray: &PovRay) -> Fault {
        let name = script.file_name().and_then(|name| name.to_str()).unwrap_or_default().to_owned();
        let mut place = None;
        let mut message: Vec<&str> = Vec::new();
        let mut in_context = false;
        for line in said.lines() {
            if let Some(found) = file_and_line(line) {
                place = Some(found);
                in_context = false;
                message.clear();
            } else if line.starts_with("File Context") {
                in_context = true;
            } else if !in_context || line.contains("Error: ") {
                in_context = false;
                message.push(line.trim());
            }
        }
        let text = if message.is_empty() { said.trim().to_owned() } else { message.join(" ") };
        let text = text.strip_prefix("Parse Error: ").unwrap_or(&text).to_owned();
        let source = system::read(&script)
            .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
            .unwrap_or_default();
        let (line, message) = match place {
            Some((file, line)) if file == name => (Some(line), text),
            // POV-Ray notices an unclosed block only after the end of the script, in the script `run.pov` that includes it.
            Some(("run.pov", _)) => (Some(source.lines().count()), text),
            Some((file, line)) => (None, format!("in {file}, line {line}: {text}")),
            None => (None, text),
        };
        let body = line.and_then(|line| body_at(&source, line));
        let outside = match opened(&message) {
            Some(Opened::ToWrite) => povray.is_confined(),
            Some(Opened::ToRead(file)) => {
                let folder = script.parent().unwrap_or(Path::new("."));
                povray.limits_reading() && file.is_none_or(|file| folder.join(file).exists())
            }
            None => false,
        };
        Fault { frame, script, line, body, message, outside }
    }

    /// Returns the diagnostic code of this failure.
    pub fn code(&self) -> Code {
        if self.outside { Code::OutsideSandbox } else { Code::BadFrame }
    }

    /// Returns the failure as a diagnostic that points to the line of the script.
    pub fn report(&self) -> Report {
        let mut report = Report::default();
        let body = self.body.as_ref().map_or_else(String::new, |body| format!(", body `{body}`"));
        let message = format!("frame {}{body}: {}", self.frame, self.message);
        let diagnostic = Diagnostic::error(self.code(), message);
        let diagnostic = match self.outside {
            true => diagnostic.help(
                "POV-Ray may read the scripts, their assets and its own files, and write in a folder of its own; with \
                 `--trust`, it may read all files, and write in the folder of the scene and in those of the results",
            ),
            false => diagnostic,
        };
        let place = self.line.and_then(|line| Some((line, system::read(&self.script).ok()?)));
        report.diagnostics.push(match place {
            None => diagnostic,
            Some((line, bytes)) => {
                let text = String::from_utf8_lossy(&bytes).into_owned();
                let start: usize =
                    text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
                let length = text[start..].lines().next().map_or(0, str::len);
                let id = report.sources.add(self.script.display().to_string(), text);
                diagnostic.at(Span::new(id, start..start + length), "POV-Ray stopped here")
            }
        });
        report
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "frame {}: {}", self.frame, self.script.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        if let Some(body) = &self.body {
            write!(f, ", body `{body}`")?;
        }
        write!(f, ": {}", self.message)
    }
}

/// The file that POV-Ray could not open, according to its message.
enum Opened<'a> {
    /// POV-Ray could not read a file. The name is `None` if the message does not contain it.
    ToRead(Option<&'a str>),
    /// POV-Ray could not write a file.
    ToWrite,
}

/// Returns the file that POV-Ray could not open, according to its message. `None` for messages about other errors.
fn opened(message: &str) -> Option<Opened<'_>> {
    let told = message.trim_end_matches('.');
    if let Some(file) = told.strip_prefix("Cannot open user file ") {
        return Some(match file.strip_suffix(" (read)") {
            Some(file) => Opened::ToRead(Some(file)),
            None => Opened::ToWrite,
        });
    }
    if let Some(file) = told.strip_prefix("Cannot open include file ") {
        return Some(Opened::ToRead(Some(file)));
    }
    ["Cannot open file", "Cannot open font file"].contains(&told).then_some(Opened::ToRead(None))
}

/// Returns the file name and the line number in the first line of a message, such as `File: scripts/frame_0060.pov  Line: 34`.
fn file_and_line(said: &str) -> Option<(&str, usize)> {
    let (path, line) = said.strip_prefix("File: ")?.rsplit_once("Line: ")?;
    Some((path.trim().rsplit('/').next()?, line.trim().parse().ok()?))
}

/// Returns the name of the body that a line of a script draws. The name is in a comment at the end of the body's last line.
fn body_at(script: &str, line: usize) -> Option<String> {
    let lines: Vec<&str> = script.lines().collect();
    let bodies = lines.iter().position(|line| *line == "// the bodies")?;
    let from = line.checked_sub(1).filter(|from| *from > bodies)?;
    let name = |line: &&str| line.rsplit_once("} // ").map(|(_, name)| name.to_owned());
    lines.get(from..)?.iter().find_map(name)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    const SCRIPT: &str = "// frame 60\n#version 3.7;\n// the bodies\n\
        sphere { <0, 1, 0>, 1 material { M } } // ball\n\
        union {\n  box { <0, 0, 0>, <1, 1, 1> }\n  fnish {}\n} // table\n";

    fn fault(said: &str) -> (Option<usize>, Option<String>, String) {
        let folder = tempfile::tempdir().unwrap();
        let script = folder.path().join("frame_0060.pov");
        fs::write(&script, SCRIPT).unwrap();
        let fault = Fault::parse(60, script, said, &PovRay::unconfined());
        (fault.line, fault.body, fault.message)
    }

    #[test]
    fn a_message_names_line_and_body() {
        let said = "File: scripts/frame_0060.pov  Line: 7\nFile Context (5 lines):\nunion {\n  fnish\n\
            Parse Error: No matching } in 'union', undeclared identifier 'fnish' found\n instead\n";
        let message = "No matching } in 'union', undeclared identifier 'fnish' found instead";
        assert_eq!(fault(said), (Some(7), Some("table".to_owned()), message.to_owned()));
        let (line, body, _) = fault("File: scripts/frame_0060.pov  Line: 4\nParse Error: x\n");
        assert_eq!((line, body), (Some(4), Some("ball".to_owned())));
        let (line, body, _) = fault("File: run.pov  Line: 5\nParse Error: x\n");
        assert_eq!((line, body), (Some(8), Some("table".to_owned())));
    }

    #[test]
    fn what_is_wrong_elsewhere_has_no_body() {
        let (line, body, _) = fault("File: scripts/frame_0060.pov  Line: 2\nParse Error: x\n");
        assert_eq!((line, body), (Some(2), None));
        let (line, _, message) = fault("File: scripts/common.inc  Line: 9\nParse Error: x\n");
        assert_eq!((line, message.as_str()), (None, "in common.inc, line 9: x"));
        assert_eq!(fault("Something else.\n"), (None, None, "Something else.".to_owned()));
    }

    #[test]
    fn files_that_cannot_be_opened_are_told_from_other_faults() {
        let kind = |message: &str| match opened(message) {
            None => "other".to_owned(),
            Some(Opened::ToWrite) => "write".to_owned(),
            Some(Opened::ToRead(file)) => format!("read {}", file.unwrap_or("?")),
        };
        assert_eq!(kind("Cannot open user file /a b/x.txt (write)."), "write");
        assert_eq!(kind("Cannot open user file ../x.txt (append)."), "write");
        assert_eq!(kind("Cannot open user file /x.txt (read)."), "read /x.txt");
        assert_eq!(kind("Cannot open include file x.inc."), "read x.inc");
        assert_eq!(kind("Cannot open file."), "read ?");
        assert_eq!(kind("No matching }"), "other");
    }
}
