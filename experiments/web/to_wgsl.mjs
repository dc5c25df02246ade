// node to_wgsl.mjs SHADER.spv SHADER.wgsl: SPIR-V to WGSL by naga. What it cannot translate is said on stderr.
import { readFileSync, writeFileSync } from "node:fs";
import { translate } from "naga-wasm";

const [spirv, wgsl] = process.argv.slice(2);
try {
    writeFileSync(wgsl, translate({ from: "spirv", to: "wgsl", source: readFileSync(spirv) }));
} catch (error) {
    const lines = (error.formatted ?? error.message).split("\n").map((line) => line.trim());
    console.error(lines.filter((line) => /^(error|= )|\w/.test(line)).join("; "));
    process.exit(1);
}
