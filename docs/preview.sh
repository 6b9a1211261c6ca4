#!/usr/bin/env bash
# Makes preview.png anew: the page of `jabuka preview`, in a real browser.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

cargo build --quiet
coproc SERVER { exec target/debug/jabuka preview --no-open scenes/damped_spring.toml 2>/dev/null; }
trap 'kill "$SERVER_PID"' EXIT
read -r address <&"${SERVER[0]}"
tests/preview/browser screenshot.mjs "$address" docs/preview.png 44 ball
