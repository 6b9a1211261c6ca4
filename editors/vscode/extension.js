// jabuka in VS Code: the language server, the moving scene beside the text, and rendered moments.

const { execFile } = require("node:child_process");
const { mkdtemp, readFile, rm } = require("node:fs/promises");
const { tmpdir } = require("node:os");
const { basename, join } = require("node:path");
const { promisify } = require("node:util");
const { commands, ProgressLocation, Uri, ViewColumn, window, workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

/** What the user reads if the program cannot be started. */
const INSTALL = "jabuka is not installed, or not on the PATH. The setting `jabuka.path` names the program.";
/** The largest text of errors that is read, bytes. */
const MAX_OUTPUT = 16 << 20;

let client;
/** The views of scenes, by the path of the scene. */
const views = new Map();
/** The folder of temporary files. */
let folder;

const program = () => workspace.getConfiguration("jabuka").get("path", "jabuka");

/** Returns true if a text looks like a scene, as `jabuka lsp` decides. Other files in TOML are left alone. */
const isScene = (document) => document?.languageId === "toml" && /^\s*(\[simulation|\[body\.|simulation\.|body\.)/m.test(document.getText());

/** Runs jabuka. Fails with what it has said. */
async function run(words, signal) {
  try {
    // jabuka keeps what it renders in its folder, and Windows looks for programs there first: that of the workspace is a stranger's.
    return await promisify(execFile)(program(), words, { cwd: folder, maxBuffer: MAX_OUTPUT, signal });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Error(error.code === "ENOENT" ? INSTALL : (error.stderr || error.message).trim());
  }
}

/** Does some work that the user can stop, and says why it fails. Returns `undefined` then. */
async function attempt(title, work) {
  const options = { location: ProgressLocation.Notification, title, cancellable: true };
  return window.withProgress(options, async (_, token) => {
    const stop = new AbortController();
    token.onCancellationRequested(() => stop.abort());
    try {
      return await work(stop.signal);
    } catch (error) {
      if (error.name !== "AbortError") {
        // Warnings come before errors.
        const lines = error.message.split("\n");
        const first = lines.find((line) => line.startsWith("error")) ?? lines[0];
        const more = "Details";
        window.showErrorMessage(first, more).then((chosen) => chosen && details(error.message));
      }
      return undefined;
    }
  });
}

async function details(content) {
  const document = await workspace.openTextDocument({ content });
  await window.showTextDocument(document, { preview: true, viewColumn: ViewColumn.Beside });
}

/** Returns the saved scene of the active editor. */
async function activeScene() {
  const document = window.activeTextEditor?.document;
  if (!isScene(document)) {
    window.showInformationMessage("Open a scene of jabuka first: a .toml file with bodies.");
    return undefined;
  }
  // jabuka reads files, and a scene may include others beside it.
  if (document.isUntitled || document.isDirty) await document.save();
  return document.isUntitled ? undefined : document;
}

/** Returns a new folder, for the results of one command. Two scenes may have the same name. */
const newFolder = () => mkdtemp(join(folder, "of-"));

/** Returns the page of a scene: its run, with all data. */
async function pageOf(document, signal) {
  const own = await newFolder();
  const page = join(own, "run.html");
  try {
    await run(["export", document.fileName, "-o", page], signal);
    return await readFile(page, "utf8");
  } finally {
    await rm(own, { recursive: true, force: true });
  }
}

/** Shows the moving scene beside its text, and again after each save. */
async function show() {
  const document = await activeScene();
  if (!document) return;
  const known = views.get(document.fileName);
  if (known) {
    known.panel.reveal(undefined, true);
    return refresh(document);
  }
  const title = basename(document.fileName);
  const panel = window.createWebviewPanel("jabuka.scene", title, { viewColumn: ViewColumn.Beside, preserveFocus: true }, { enableScripts: true, retainContextWhenHidden: true, localResourceRoots: [] });
  const view = { panel };
  views.set(document.fileName, view);
  panel.onDidDispose(() => {
    view.stop?.abort();
    views.delete(document.fileName);
  });
  await refresh(document);
}

/** Computes a scene again, and shows it in its view. A run with errors leaves the view as it is; the text shows the errors. */
async function refresh(document) {
  const view = views.get(document.fileName);
  // The newest text counts: an older run that is still computed is given up.
  view.stop?.abort();
  const stop = (view.stop = new AbortController());
  const title = `jabuka computes ${basename(document.fileName)}`;
  const page = await attempt(title, (signal) => pageOf(document, AbortSignal.any([signal, stop.signal])));
  if (page && !stop.signal.aborted) view.panel.webview.html = page;
}

/** Renders a moment with POV-Ray, and opens the image. */
async function render() {
  const document = await activeScene();
  if (!document) return;
  const validateInput = (text) => (text.trim() && Number(text) >= 0 ? undefined : "A time in seconds, such as 0.5");
  const time = await window.showInputBox({ prompt: "The moment, s", value: "0", validateInput });
  if (time === undefined) return;
  const image = join(await newFolder(), `${basename(document.fileName, ".toml")}_${Number(time)}s.png`);
  const words = ["still", document.fileName, "--time", String(Number(time)), "-o", image];
  const done = await attempt(`POV-Ray renders ${basename(document.fileName)}`, (signal) => run(words, signal));
  if (done) await commands.executeCommand("vscode.open", Uri.file(image), ViewColumn.Beside);
}

/** Starts the language server. */
async function serve() {
  client = new LanguageClient("jabuka", "jabuka", { command: program(), args: ["lsp"], options: { cwd: folder } }, { documentSelector: [{ language: "toml" }] });
  try {
    await client.start();
  } catch {
    client = undefined;
    window.showWarningMessage(INSTALL);
  }
}

async function restart() {
  await client?.stop();
  await serve();
}

const tellWhetherScene = () => commands.executeCommand("setContext", "jabuka.isScene", isScene(window.activeTextEditor?.document));

exports.activate = async ({ subscriptions }) => {
  folder = await mkdtemp(join(tmpdir(), "jabuka-"));
  subscriptions.push(
    commands.registerCommand("jabuka.show", show),
    commands.registerCommand("jabuka.render", render),
    workspace.onDidSaveTextDocument((document) => views.has(document.fileName) && refresh(document)),
    workspace.onDidChangeTextDocument(tellWhetherScene),
    workspace.onDidChangeConfiguration((change) => change.affectsConfiguration("jabuka.path") && restart()),
    window.onDidChangeActiveTextEditor(tellWhetherScene),
  );
  await tellWhetherScene();
  await serve();
};

exports.deactivate = async () => {
  await client?.stop();
  await rm(folder, { recursive: true, force: true });
};
