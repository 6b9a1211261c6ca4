// Starts a real headless browser: Chromium, or Firefox if JABUKA_BROWSER_NAME is `firefox`.

import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";

const { chromium, firefox } = createRequire(`${process.env.JABUKA_MODULES}/`)("playwright-core");

export const IS_FIREFOX = process.env.JABUKA_BROWSER_NAME === "firefox";

/** The possible paths of the system's browser; the first existing one is used. */
const PROGRAMS = IS_FIREFOX
  ? ["/usr/bin/firefox-esr", "/usr/bin/firefox", "/Applications/Firefox.app/Contents/MacOS/firefox"]
  : [
      "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome",
      "/Applications/Chromium.app/Contents/MacOS/Chromium", "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    ];

/** Options for WebGL in software, which gives the same pixels on every machine, and without background connections. */
const OPTIONS = [
  "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync",
];

/** The same for Firefox, which asks for WebGL by GLX, and so for an X server, unless it is told to use EGL. */
const ENVIRONMENT = { MOZ_WEBGL_FORCE_EGL: "1", LIBGL_ALWAYS_SOFTWARE: "1" };
const PREFERENCES = { "webgl.force-enabled": true, "app.normandy.enabled": false, "services.settings.server": "data:," };

/** The folder in which Firefox saves files: the library tells nothing of them. */
export const DOWNLOADS = IS_FIREFOX ? mkdtempSync(join(tmpdir(), "jabuka-")) : undefined;
process.on("exit", () => DOWNLOADS && rmSync(DOWNLOADS, { recursive: true, force: true }));

/**
 * Starts the browser. `host` is a name that it takes for this machine. `colorScheme` is that of all pages in Firefox, in which pages cannot have
 * their own.
 */
export async function launch({ host, colorScheme = "light" } = {}) {
  const executablePath = process.env[IS_FIREFOX ? "JABUKA_FIREFOX" : "JABUKA_BROWSER"] ?? PROGRAMS.find(existsSync);
  if (!IS_FIREFOX) {
    const hosts = host ? [`--host-resolver-rules=MAP ${host} 127.0.0.1`] : [];
    return chromium.launch({ executablePath, headless: true, args: [...OPTIONS, ...hosts] });
  }
  const firefoxUserPrefs = { ...PREFERENCES, "layout.css.prefers-color-scheme.content-override": colorScheme === "dark" ? 0 : 1 };
  if (host) firefoxUserPrefs["network.dns.localDomains"] = host;
  // By its channel, the library controls the system's Firefox, and not one of its own.
  const env = { ...process.env, ...ENVIRONMENT };
  return firefox.launch({ channel: "moz-firefox", executablePath, headless: true, firefoxUserPrefs, downloadsPath: DOWNLOADS, env });
}
