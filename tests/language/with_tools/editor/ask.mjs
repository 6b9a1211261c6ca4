// Asks taplo's language server for completions and help at one place of each document, as an editor does.
//
// Standard input: a JSON list of documents with `|` at the place. Standard output: for each document, the labels of the
// completions at the place, and the help text for the key or value there. The documents are in the current folder.

import { readFile } from 'node:fs/promises';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

// taplo would download the public catalog of schemas.
globalThis.fetch = () => Promise.reject(new Error('no network'));

const { TaploLsp } = (await import('@taplo/lsp')).default;

const environment = {
    now: () => new Date(),
    envVar: (name) => process.env[name],
    envVars: () => Object.entries(process.env),
    stdErrAtty: () => false,
    stdin: process.stdin,
    stdout: process.stderr,
    stderr: process.stderr,
    glob: () => [],
    readFile: (name) => readFile(name),
    writeFile: async () => {},
    urlToFilePath: (url) => (url.startsWith('file://') ? decodeURI(url.slice('file://'.length)) : ''),
    isAbsolute: path.isAbsolute,
    cwd: () => process.cwd(),
    findConfigFile: () => undefined,
};

// The callbacks that wait for an answer, by the number of the request.
const waiting = new Map();

const server = await TaploLsp.initialize(environment, {
    onMessage(message) {
        if (message.method === 'workspace/configuration') {
            const result = [{ schema: { enabled: true, catalogs: [], associations: {} } }];
            server.send({ jsonrpc: '2.0', id: message.id, result });
        } else if (!message.method) {
            waiting.get(message.id)(message.result);
        }
    },
});

let asked = 0;

function ask(method, params) {
    asked += 1;
    const answer = new Promise((resolve) => waiting.set(asked, resolve));
    server.send({ jsonrpc: '2.0', id: asked, method, params });
    return answer;
}

function tell(method, params) {
    server.send({ jsonrpc: '2.0', method, params });
}

const root = pathToFileURL(process.cwd()).href;
await ask('initialize', { processId: null, rootUri: root, capabilities: {}, workspaceFolders: [{ uri: root, name: 'scenes' }] });
tell('initialized', {});

const out = [];
for (const [number, marked] of JSON.parse(readFileSync(0, 'utf8')).entries()) {
    const uri = `${root}/asked_${number}.toml`;
    const [before, after] = marked.split('|');
    tell('textDocument/didOpen', { textDocument: { uri, languageId: 'toml', version: 1, text: before + after } });
    const lines = before.split('\n');
    const place = { textDocument: { uri }, position: { line: lines.length - 1, character: lines.at(-1).length } };
    // The server loads the schema in the background and does not report when it is ready, so ask repeatedly.
    let items = [];
    for (let tries = 0; items.length === 0 && tries < 200; tries += 1) {
        if (tries > 0) await new Promise((resolve) => setTimeout(resolve, 50));
        const completion = await ask('textDocument/completion', place);
        items = completion?.items ?? completion ?? [];
    }
    const hover = await ask('textDocument/hover', place);
    out.push({ labels: items.map((item) => item.label), hover: hover?.contents?.value ?? '' });
}
process.stdout.write(JSON.stringify(out), () => process.exit(0));
