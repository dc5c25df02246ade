// node verify.mjs FOLDER ANSWERS: runs the WGSL of an exported folder in headless Chromium, on SwiftShader, and puts what
// each frame's rays found into ANSWERS: NAME.hits.bin, NAME.made_rays.bin, NAME.made_count.bin, and device.txt.
import { spawn } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join, normalize } from "node:path";

const browserFlags = [
    "--headless=new", "--no-sandbox", "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader",
    "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--enable-features=Vulkan", "--use-vulkan=swiftshader",
    "--no-first-run", "--disable-dev-shm-usage",
];
const longest_s = 540;
const [folder, answers] = process.argv.slice(2);
const names = readdirSync(join(folder, "frames")).filter((name) => name.endsWith(".json"));
const page = `<!doctype html><title>verify</title><script src="run.js"></script><script>
const post = (name, body) => fetch("answers/" + name, { method: "POST", body });
const errors = [];
verifyFolder(${JSON.stringify(names.map((name) => name.slice(0, -5)))}, (line) => line.startsWith("error") && errors.push(line),
    async (name, found) => { for (const [what, words] of Object.entries(found)) await post(name + "." + what + ".bin", words); })
    .then((device) => post(errors.length ? "failed" : "device.txt", errors[0] ?? device), (error) => post("failed", error.message));
</script>`;

const profile = mkdtempSync(join(tmpdir(), "ssrlab_browser_"));
let browser = null, ended = false;
function end(code, message = "") {
    if (ended) return;
    ended = true;
    if (message) console.error(message);
    const leave = () => {
        rmSync(profile, { recursive: true, force: true, maxRetries: 20, retryDelay: 100 });
        process.exit(code);
    };
    if (!browser?.pid || browser.exitCode !== null) leave();
    browser.on("exit", leave);
    process.kill(-browser.pid, "SIGKILL"); // with all its processes
}

const server = createServer((request, response) => {
    const path = new URL(request.url, "http://127.0.0.1").pathname;
    if (request.method === "POST") {
        const parts = [];
        request.on("data", (part) => parts.push(part));
        request.on("end", () => {
            const name = path.split("/").pop(), body = Buffer.concat(parts);
            response.end();
            if (name === "failed") end(1, body.toString());
            writeFileSync(join(answers, name), body);
            if (name === "device.txt") end(0);
        });
        return;
    }
    try {
        const body = path === "/" ? page : readFileSync(join(folder, normalize(decodeURIComponent(path))));
        response.setHeader("Content-Type", path === "/" ? "text/html" : "application/octet-stream");
        if (path.endsWith(".js")) response.setHeader("Content-Type", "text/javascript");
        response.end(body);
    } catch {
        response.statusCode = 404;
        response.end();
    }
});
server.listen(0, "127.0.0.1", () => {
    const address = `http://127.0.0.1:${server.address().port}/`;
    browser = spawn("chromium", [...browserFlags, `--user-data-dir=${profile}`, address], { stdio: "ignore", detached: true });
    browser.on("error", () => end(1, "chromium is not installed: install Debian's package chromium"));
    browser.on("exit", (code) => end(1, `chromium ended with exit code ${code}`));
    setTimeout(() => end(1, `no answer from the browser within ${longest_s} s`), longest_s * 1000);
});
