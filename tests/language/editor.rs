//! `jabuka lsp`, spoken to as an editor does.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Stdio};

use serde_json::{Value, json};

use crate::support::jabuka;

/// An editor that has started the server.
struct Editor {
    server: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    requests: u64,
}

impl Editor {
    fn new() -> Editor {
        let mut command = jabuka();
        command.arg("lsp").stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut server = command.spawn().unwrap();
        let (input, output) = (server.stdin.take(), BufReader::new(server.stdout.take().unwrap()));
        let mut editor = Editor { server, input, output, requests: 0 };
        let can = editor.ask("initialize", &json!({ "capabilities": {} }));
        assert_eq!(can["capabilities"]["hoverProvider"], true, "{can}");
        editor.tell("initialized", &json!({}));
        editor
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        let input = self.input.as_mut().unwrap();
        write!(input, "Content-Length: {}\r\n\r\n{text}", text.len()).unwrap();
        input.flush().unwrap();
    }

    fn receive(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.output.read_line(&mut line).unwrap() > 0, "the server has ended");
            match line.trim() {
                "" => break,
                header => {
                    if let Some(number) = header.strip_prefix("Content-Length: ") {
                        length = number.parse().unwrap();
                    }
                }
            }
        }
        let mut bytes = vec![0; length];
        self.output.read_exact(&mut bytes).unwrap();
        serde_json::from_slice(&bytes).unwrap()
    }

    fn tell(&mut self, method: &str, parameters: &Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": parameters }));
    }

    fn ask(&mut self, method: &str, parameters: &Value) -> Value {
        self.requests += 1;
        let id = self.requests;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": parameters }));
        let answer = self.receive();
        assert_eq!(answer["id"], id, "{answer}");
        assert!(answer.get("error").is_none(), "{answer}");
        answer["result"].clone()
    }

    /// Opens a text, and returns the problems that the server finds in it.
    fn open(&mut self, uri: &str, text: &str) -> Vec<Value> {
        let document = json!({ "uri": uri, "languageId": "toml", "version": 1, "text": text });
        self.tell("textDocument/didOpen", &json!({ "textDocument": document }));
        self.problems(uri)
    }

    fn change(&mut self, uri: &str, text: &str) -> Vec<Value> {
        let changes = json!([{ "text": text }]);
        let document = json!({ "uri": uri, "version": 2 });
        self.tell("textDocument/didChange", &json!({ "textDocument": document, "contentChanges": changes }));
        self.problems(uri)
    }

    fn problems(&mut self, uri: &str) -> Vec<Value> {
        let note = self.receive();
        assert_eq!(note["method"], "textDocument/publishDiagnostics", "{note}");
        assert_eq!(note["params"]["uri"], uri);
        note["params"]["diagnostics"].as_array().unwrap().clone()
    }

    fn at(&mut self, method: &str, uri: &str, [line, character]: [u32; 2]) -> Value {
        let place = json!({ "line": line, "character": character });
        self.ask(method, &json!({ "textDocument": { "uri": uri }, "position": place }))
    }

    fn completions(&mut self, uri: &str, place: [u32; 2]) -> Vec<String> {
        let items = self.at("textDocument/completion", uri, place);
        let items = items.as_array().unwrap_or_else(|| panic!("no completions at {place:?}")).clone();
        items.iter().map(|item| item["label"].as_str().unwrap().to_owned()).collect()
    }

    /// Ends the connection as the protocol demands.
    fn end(mut self) {
        assert_eq!(self.ask("shutdown", &Value::Null), Value::Null);
        self.tell("exit", &Value::Null);
        assert!(self.server.wait().unwrap().success());
    }
}

/// Replaces ranges of a text, as an editor does that counts UTF-16 units.
fn edited(text: &str, edits: &Value) -> String {
    let mut lines: Vec<Vec<u16>> = text.split('\n').map(|line| line.encode_utf16().collect()).collect();
    for edit in edits.as_array().unwrap() {
        let number =
            |end: &str, key: &str| usize::try_from(edit["range"][end][key].as_u64().unwrap()).unwrap();
        let line = number("start", "line");
        assert_eq!(line, number("end", "line"), "the edits of this test stay in a line");
        let range = number("start", "character")..number("end", "character");
        lines[line].splice(range, edit["newText"].as_str().unwrap().encode_utf16());
    }
    lines.iter().map(|line| String::from_utf16(line).unwrap()).collect::<Vec<_>>().join("\n")
}

const SCENE: &str =
    "[simulation]\nduration = 1\n\n[body.ball]\nshape.sphere.radius = 0.5\nvelosity = [1, 0, 0]\n";

#[test]
fn a_slip_is_marked_where_it_is_and_mended_by_an_action() {
    let mut editor = Editor::new();
    let uri = "untitled:Untitled-1";
    let text = SCENE.replace("velosity", "# 🎾\nvelosity");
    let problems = editor.open(uri, &text);
    assert_eq!(problems.len(), 1, "{problems:?}");
    let range = &problems[0]["range"];
    assert_eq!(
        *range,
        json!({ "start": { "line": 6, "character": 0 }, "end": { "line": 6, "character": 8 } })
    );
    assert_eq!((&problems[0]["severity"], &problems[0]["code"]), (&json!(1), &json!("unknown-key")));
    let context = json!({ "diagnostics": problems });
    let about = json!({ "textDocument": { "uri": uri }, "range": range, "context": context });
    let actions = editor.ask("textDocument/codeAction", &about);
    assert_eq!(actions[0]["title"], "Write velocity", "{actions}");
    let mended = edited(&text, &actions[0]["edit"]["changes"][uri]);
    assert_eq!(mended, text.replace("velosity", "velocity"));
    assert_eq!(editor.change(uri, &mended), Vec::<Value>::new());
    editor.end();
}

#[test]
fn columns_count_utf_16_units() {
    let mut editor = Editor::new();
    let uri = "untitled:2";
    let text =
        "[simulation]\nduration = 1\n[body]\n\"🎾\" = { shape.sphere.radius = 0.5, velosity = [1, 0, 0] }\n";
    let problems = editor.open(uri, text);
    let before = text.lines().nth(3).unwrap().split("velosity").next().unwrap().encode_utf16().count();
    let found: Vec<&Value> = problems.iter().filter(|problem| problem["code"] == "unknown-key").collect();
    assert_eq!(found.len(), 1, "{problems:?}");
    assert_eq!(found[0]["range"]["start"], json!({ "line": 3, "character": before }));
    editor.end();
}

#[test]
fn keys_are_explained_and_completed() {
    let mut editor = Editor::new();
    let uri = "untitled:3";
    let text = format!(
        "{}\n[body.wall]\nres\n[body.\n[joint.rod]\nrod.between = [\"\nfixed = \n",
        SCENE.replace("velosity", "velocity")
    );
    editor.open(uri, &text);
    let hover = editor.at("textDocument/hover", uri, [5, 3]);
    assert!(
        hover["contents"]["value"].as_str().unwrap().contains("meaning   Its velocity at the start"),
        "{hover}"
    );
    let hover = editor.at("textDocument/hover", uri, [4, 16]);
    assert!(
        hover["contents"]["value"].as_str().unwrap().contains("body.NAME.shape.sphere.radius"),
        "{hover}"
    );
    assert_eq!(editor.at("textDocument/hover", uri, [5, 14]), Value::Null);
    let keys = editor.completions(uri, [8, 3]);
    assert!(keys.contains(&"restitution".to_owned()) && keys.contains(&"velocity".to_owned()), "{keys:?}");
    assert!(editor.completions(uri, [3, 1]).contains(&"simulation".to_owned()));
    assert_eq!(editor.completions(uri, [11, 16]), ["ball", "wall"]);
    editor.end();
}

#[test]
fn other_texts_in_toml_are_left_alone() {
    let mut editor = Editor::new();
    assert_eq!(editor.open("file:///nowhere/Cargo.toml", "[package]\nname = \"x\"\n"), Vec::<Value>::new());
    editor.end();
}

#[test]
fn files_beside_the_scene_are_found_and_their_problems_named() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("part.toml"), "[body.ball]\nshape.sphere.radios = 1\n").unwrap();
    let path = folder.path().join("scene.toml");
    let mut editor = Editor::new();
    let uri = format!("file://{}", path.display());
    // The editor has not saved the scene.
    let problems = editor.open(&uri, "include = [\"part.toml\"]\n[simulation]\nduration = 1\n");
    let message = problems[0]["message"].as_str().unwrap();
    assert!(message.contains("part.toml, line 2"), "{message}");
    assert_eq!(problems[0]["range"]["start"], json!({ "line": 0, "character": 0 }));
    editor.end();
}

#[test]
fn a_broken_connection_ends_the_server() {
    let mut editor = Editor::new();
    editor.input = None;
    let mut rest = Vec::new();
    editor.output.read_to_end(&mut rest).unwrap();
    editor.server.wait().unwrap();
}
