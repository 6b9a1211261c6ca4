//! A language server for scenes: errors and warnings while the user types, their fixes, explanations of keys, and completions.
//!
//! It speaks the Language Server Protocol over standard input and output (<https://microsoft.github.io/language-server-protocol/>).
//! `document` converts places, `problems` makes diagnostics and fixes, `keys` explains and completes.
//!
//! A text is checked again after each change, but not while further messages wait: only the newest text counts.

mod document;
mod keys;
mod problems;

use std::collections::HashMap;
use std::io;

use lsp_server::{Connection, ErrorCode, Message, Notification, Request, Response};
use serde_json::{Value, json};

use self::document::Document;

/// Serves an editor until it ends the connection.
///
/// # Errors
/// If the editor does not follow the protocol, or standard input or output fails.
pub fn serve() -> io::Result<()> {
    let (connection, threads) = Connection::stdio();
    let served = answer(&connection).map_err(|error| io::Error::other(error.to_string()));
    // The threads end when the connection is dropped.
    drop(connection);
    let joined = threads.join();
    served.and(joined)
}

/// What the server can do.
fn capabilities() -> Value {
    json!({
        "positionEncoding": "utf-16",
        // The editor sends the whole text after each change.
        "textDocumentSync": { "openClose": true, "change": 1 },
        "codeActionProvider": { "codeActionKinds": ["quickfix"] },
        "hoverProvider": true,
        "completionProvider": { "triggerCharacters": [".", "[", "\""] },
    })
}

fn answer(connection: &Connection) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
    let (id, _) = connection.initialize_start()?;
    let server = json!({ "name": "jabuka", "version": env!("CARGO_PKG_VERSION") });
    connection.initialize_finish(id, json!({ "capabilities": capabilities(), "serverInfo": server }))?;
    let mut documents = HashMap::new();
    let mut changed = Vec::new();
    while let Ok(message) = connection.receiver.recv() {
        match message {
            Message::Request(request) => {
                if connection.handle_shutdown(&request)? {
                    return Ok(());
                }
                connection.sender.send(Message::Response(response(request, &documents)))?;
            }
            Message::Notification(note) => changed.extend(take(&note, &mut documents)),
            Message::Response(_) => {}
        }
        if connection.receiver.is_empty() {
            changed.sort();
            changed.dedup();
            for uri in changed.drain(..) {
                let found = documents.get(&uri).map_or_else(Vec::new, problems::of);
                let parameters = json!({ "uri": uri, "diagnostics": found });
                let note = Notification::new("textDocument/publishDiagnostics".to_owned(), parameters);
                connection.sender.send(Message::Notification(note))?;
            }
        }
    }
    Ok(())
}

/// Takes a change of a document. Returns its URI if its problems may have changed.
fn take(note: &Notification, documents: &mut HashMap<String, Document>) -> Option<String> {
    let about = &note.params["textDocument"];
    let uri = about["uri"].as_str()?;
    match &*note.method {
        "textDocument/didOpen" => {
            documents.insert(uri.to_owned(), Document::new(uri, about["text"].as_str()?));
        }
        "textDocument/didChange" => {
            let newest = note.params["contentChanges"].as_array()?.last()?;
            documents.insert(uri.to_owned(), Document::new(uri, newest["text"].as_str()?));
        }
        "textDocument/didClose" => {
            documents.remove(uri)?;
        }
        // Other files, which the scene reads, may have been saved.
        "textDocument/didSave" => {}
        _ => return None,
    }
    Some(uri.to_owned())
}

fn response(request: Request, documents: &HashMap<String, Document>) -> Response {
    let uri = request.params["textDocument"]["uri"].as_str();
    let document = uri.and_then(|uri| documents.get(uri));
    let place = &request.params["position"];
    let result = match &*request.method {
        "textDocument/codeAction" => {
            document.map(|document| problems::fixes(document, &request.params["range"]))
        }
        "textDocument/hover" => document.and_then(|document| keys::explanation(document, place)),
        "textDocument/completion" => document.and_then(|document| keys::completions(document, place)),
        method => {
            let message = format!("jabuka has no method `{method}`");
            return Response::new_err(request.id, ErrorCode::MethodNotFound as i32, message);
        }
    };
    Response::new_ok(request.id, result)
}
