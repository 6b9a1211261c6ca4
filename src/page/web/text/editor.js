// The editor for the text of the scene: CodeMirror with the keys and the errors of jabuka.

import {
  EditorState, EditorView, HighlightStyle, StreamLanguage, autocompletion, bracketMatching, closeBrackets, closeBracketsKeymap, completionKeymap,
  defaultKeymap, drawSelection, highlightActiveLine, highlightSelectionMatches, history, historyKeymap, hoverTooltip, isolateHistory, keymap, lineNumbers,
  lintGutter, lintKeymap, searchKeymap, setDiagnostics, syntaxHighlighting, tags, toml,
} from "../libraries/codemirror.js";
import { draggedNumbers, numberKeys } from "./dragged_numbers.js";
import { completions, described } from "./scene_keys.js";
import { changeInStep } from "./undo_step.js";

/** The colors of the page, in light and dark. */
const COLORS = HighlightStyle.define([
  { tag: tags.comment, color: "var(--quiet)" },
  { tag: tags.string, color: "var(--kinetic)" },
  { tag: [tags.number, tags.bool, tags.atom], color: "var(--accent)" },
  { tag: [tags.propertyName, tags.definition(tags.variableName), tags.variableName], color: "var(--ink)" },
  { tag: [tags.standard(tags.variableName), tags.tagName, tags.heading], color: "var(--ink)", fontWeight: "600" },
]);

/** The look of the page. The editor lies in a tree of its own, so that its styles need no exception from the page's security policy. */
const LOOK = EditorView.theme({
  "&": { height: "100%", fontSize: "13px" },
  ".cm-scroller": { fontFamily: "ui-monospace, monospace" },
  ".cm-gutters": { background: "transparent", color: "var(--quiet)", borderRightColor: "var(--line)" },
  ".cm-activeLine, .cm-activeLineGutter": { background: "color-mix(in srgb, var(--accent) 7%, transparent)" },
  ".cm-content": { caretColor: "var(--ink)" },
  ".cm-cursor": { borderLeftColor: "var(--ink)" },
  ".cm-tooltip": { background: "var(--paper)", color: "var(--ink)", border: "1px solid var(--line)", maxWidth: "34em" },
  ".cm-diagnostic": { whiteSpace: "pre-wrap" },
  ".described": { padding: "4px 8px" },
  ".cm-panels": { background: "var(--paper)", color: "var(--ink)" },
});

/** Returns the offset of a place in a document. Lines and columns count from 1, and columns count characters, not UTF-16 units. */
function offset(document, line, column) {
  if (line > document.lines) return document.length;
  const { from, text } = document.line(line);
  return from + [...text].slice(0, column - 1).join("").length;
}

function range(document, place) {
  return { from: offset(document, place.line, place.column), to: offset(document, place.end_line, place.end_column) };
}

/** Makes an editor in an element. `changed` receives the text after each change. */
export function makeEditor(parent, text, changed) {
  const extensions = [
    lineNumbers(), lintGutter(), history(), drawSelection(), highlightActiveLine(), bracketMatching(), closeBrackets(),
    highlightSelectionMatches(), autocompletion({ override: [completions] }), hoverTooltip(described),
    StreamLanguage.define(toml), syntaxHighlighting(COLORS), LOOK, draggedNumbers,
    keymap.of([...numberKeys, ...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap, ...completionKeymap, ...lintKeymap]),
    EditorView.lineWrapping,
    EditorView.contentAttributes.of({ "aria-label": "The text of the scene", tabindex: "0" }),
    EditorView.updateListener.of((update) => update.docChanged && !isTaken && changed(update.state.doc.toString())),
  ];
  // True while the editor takes a text that the page has already.
  let isTaken = false;
  const root = parent.attachShadow({ mode: "open" });
  const view = new EditorView({ parent: root, root, state: EditorState.create({ doc: text, extensions }) });
  return {
    view,
    /** Replaces the text, and forgets the history of the one before. */
    set(text) {
      view.setState(EditorState.create({ doc: text, extensions }));
    },
    /** Replaces what differs in another version of the text. The user can take that back. */
    update(text) {
      const old = view.state.doc.toString();
      const most = Math.min(old.length, text.length);
      let [from, same] = [0, 0];
      while (from < most && old[from] === text[from]) from++;
      while (same < most - from && old[old.length - 1 - same] === text[text.length - 1 - same]) same++;
      if (old === text) return;
      isTaken = true;
      view.dispatch({ changes: { from, to: old.length - same, insert: text.slice(from, text.length - same) }, annotations: isolateHistory.of("full") });
      isTaken = false;
    },
    /** Changes the text at some places. What begins a step is undone apart from the changes before it. */
    change(changes, begins) {
      changeInStep(view, changes, begins);
    },
    /** Shows the errors and warnings of jabuka that lie in the file of this name. */
    mark(entries, name) {
      const { doc } = view.state;
      const own = entries.filter((entry) => entry.file === name);
      const marks = own.map((entry) => ({
        ...range(doc, entry),
        severity: entry.severity,
        source: entry.code,
        message: [entry.message, entry.label, entry.help && `help: ${entry.help}`].filter(Boolean).join("\n"),
        actions: fixes(entry, name),
      }));
      view.dispatch(setDiagnostics(view.state, marks.sort((a, b) => a.from - b.from)));
    },
  };
}

/** Returns the action that mends an error, if all of it is in this file. */
function fixes({ fix = [] }, name) {
  if (!fix.length || fix.some(({ file }) => file !== name)) return [];
  const apply = (view) => {
    const { doc } = view.state;
    view.dispatch({ changes: fix.map((edit) => ({ ...range(doc, edit), insert: edit.text })) });
  };
  const [first] = fix;
  const what = fix.length === 1 && first.text.trim().length < 30 ? first.text.trim() : "";
  return [{ name: what ? `Write ${what}` : "Mend it", apply }];
}
