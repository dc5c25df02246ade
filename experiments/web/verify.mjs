// node verify.mjs ANSWERS FOLDER…: runs the WGSL of exported folders in headless Chromium, on SwiftShader, and puts what the
// rays of each frame found into ANSWERS: I.NAME.hits.bin, I.NAME.made_rays.bin, I.NAME.made_count.bin of the folder with
// index I, and device.txt.
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
const longest_silence_s = 540;
const [answers, ...folders] = process.argv.slice(2);
const frameNames = (folder) => readdirSync(join(folder, "frames")).filter((name) => name.endsWith(".json")).map((name) => name.slice(0, -5));
const page = `<!doctype html><title>verify</title><script src="0/run.js"></script><script>
const folders = ${JSON.stringify(folders.map((folder) => [folder, frameNames(folder)]))};
const post = (name, body) => fetch("answers/" + name, { method: "POST", body });
const errors = [];
async function verifyAll() {
    const device = await openDevice();
    for (const [i, [folder, names]] of folders.entries())
        try {
            await verifyFolder(device, i + "/", names, (line) => line.startsWith("error") && errors.push(line), async (name, found) => {
                for (const [what, words] of Object.entries(found)) await post(i + "." + name + "." + what + ".bin", words);
            });
            if (errors.length) throw new Error(errors[0]);
        } catch (error) {
            throw new Error(folder + ": " + error.message);
        }
    await post("device.txt", device.name);
}
verifyAll().catch((error) => post("failed", error.message));
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

const silence = setTimeout(() => end(1, `no answer from the browser within ${longest_silence_s} s`), longest_silence_s * 1000);
const server = createServer((request, response) => {
    silence.refresh();
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
        const [, folder, file] = path.match(/^\/(\d+)(\/.*)$/) ?? [];
        const body = path === "/" ? page : readFileSync(join(folders[folder], normalize(decodeURIComponent(file))));
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
});
