// What the visitor sees and does: the frame with its reflections, and the sweep.
"use strict";

const element = (id) => document.getElementById(id);
const statuses = ["", "hit", "left the screen", "maximum distance", "out of steps", "met surfaces that face away",
                  "stopped behind the frame", "impossible: a bug"];
const colours = [[40, 40, 40], [70, 170, 90], [70, 110, 200], [120, 90, 180], [220, 170, 40], [150, 150, 150],
                 [200, 70, 60], [255, 0, 255]];
const palette = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#17becf", "#8c564b", "#e377c2", "#7f7f7f"];
const recorded = parseCsv(DATA.recorded["results.csv"]);
const page = { device: null, rays: {}, dda: {}, measured: [], stopping: false, drawn: 0 };

const frameOf = (scene, technique, surface) => DATA.frames[scene][technique][surface];
const rowsOf = (scene, technique, surface) =>
    recorded.rows.filter((row) => row.scene === scene && row.technique === technique && row.surface === surface);

/// Values of the sweep's numbers in a row of results.
function numbersOf(row) {
    return Object.fromEntries(Object.keys(DATA.swept[row.technique]).map((name) => [name, Number(row[name])]));
}

async function raysOf(scene) {
    const [technique] = Object.keys(DATA.frames[scene]), [surface] = Object.keys(DATA.frames[scene][technique]);
    page.rays[scene] ??= makeRays(page.device, frameOf(scene, technique, surface));
    return page.rays[scene];
}

async function trace(scene, technique, surface, numbers) {
    const rays = await raysOf(scene);
    const prepared = await prepare(page.device, frameOf(scene, technique, surface), rays, numbers);
    const hits = (await traceFrame(page.device, prepared)).subarray(0, rays.length / 4);
    release(prepared);
    return { rays, hits };
}

const pixelOf = (word) => [word & 0x3fff, (word >>> 14) & 0x3fff];
const agrees = (a, b, at) => a[at] === b[at] || ((a[at] >>> 28) === (b[at] >>> 28) && ![1, 6].includes(a[at] >>> 28));

function countOf(hits, status) {
    let count = 0;
    for (let at = 0; at < hits.length; at += 2) if (hits[at] >>> 28 === status) ++count;
    return count;
}

// ---- The picture
async function litImage(scene) {
    const image = new Image();
    image.src = DATA.colours[scene];
    await image.decode();
    return image;
}

async function litPixels(scene, width, height) {
    const image = await litImage(scene);
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [width, height];
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, width, height);
}

/// Colours of a ray's pixel: half its own and half of what the ray met; or what it was judged to be.
function colourOf(view, lit, own, word, right) {
    if (view === "statuses") return colours[word >>> 28];
    if (view === "agreement") return right ? [70, 170, 90] : [220, 60, 50];
    const [x, y] = pixelOf(word), met = 4 * (y * lit.width + x);
    return [0, 1, 2].map((i) => 0.35 * lit.data[own + i] + (word >>> 28 === 1 ? 0.65 * lit.data[met + i] : 0));
}

function showLegend(view) {
    const entries = { reflections: [], agreement: [["as dda", [70, 170, 90]], ["another answer", [220, 60, 50]]],
                      statuses: statuses.map((name, i) => [name, colours[i]]).slice(1, 7) }[view];
    element("legend").innerHTML = swatches(entries.map(([name, colour]) => [name, `rgb(${colour})`]));
}

async function draw({ rays, hits }, dda, scene, view) {
    const [width, height] = Object.values(Object.values(DATA.frames[scene])[0])[0].size_px;
    const lit = await litPixels(scene, width, height), shown = new ImageData(new Uint8ClampedArray(lit.data), width, height);
    if (view !== "reflections") for (let i = 0; i < shown.data.length; ++i) if (i % 4 !== 3) shown.data[i] *= 0.35;
    for (let ray = 0; ray < rays.length / 8; ++ray) {
        const [x, y] = pixelOf(rays[8 * ray + 7]), own = 4 * (y * width + x);
        shown.data.set(colourOf(view, lit, own, hits[2 * ray], agrees(hits, dda, 2 * ray)), own);
    }
    const canvas = element("picture");
    [canvas.width, canvas.height] = [width, height];
    canvas.getContext("2d").putImageData(shown, 0, 0);
    showLegend(view);
}

const percent = (share) => `${(100 * share).toFixed(2)} %`;

function showFacts({ rays, hits }, dda, row) {
    const count = rays.length / 8;
    let same = 0;
    for (let at = 0; at < hits.length; at += 2) if (agrees(hits, dda, at)) ++same;
    const facts = [["rays", count], ["same status and pixel as dda", percent(same / count)]];
    for (let status = 1; status < statuses.length; ++status)
        if (countOf(hits, status)) facts.push([statuses[status], percent(countOf(hits, status) / count)]);
    if (row) facts.push(["fetches a ray (recorded)", row.fetches_mean], ["steps a ray (recorded)", row.steps_mean],
                        ["F1 against the true reflections (recorded)", row.f1_1px]);
    element("facts").tBodies[0].innerHTML = facts.map(([name, value]) => `<tr><td>${name}</td><td>${value}</td></tr>`).join("");
}

// ---- The curve
const costOf = (row) => Number(row.trace_ms_median) + Number(row.structures_ms_median || 0);
const numberOf = (row) => Object.values(numbersOf(row))[0] ?? 0;
const swatches = (entries) =>
    entries.map(([name, colour]) => `<span class="swatch" style="background:${colour}"></span>${name}`).join(" ");

const markOf = (exponent) => Number((10 ** exponent).toPrecision(2));

/// Where a row lies in the drawing, and the marks of both axes.
function axesOf(rows) {
    const costs = rows.map((row) => Math.log10(costOf(row))), scores = rows.map((row) => Number(row.f1_1px));
    const left = Math.min(...costs) - 0.05, right = Math.max(...costs) + 0.05;
    const low = Math.max(0, Math.min(...scores) - 0.02), high = Math.min(1, Math.max(...scores) + 0.02);
    const x = (row) => 60 + 520 * (Math.log10(costOf(row)) - left) / (right - left);
    const y = (row) => 30 + 290 * (high - Number(row.f1_1px)) / (high - low);
    const marks = [0, 0.25, 0.5, 0.75, 1].map((part) =>
        `<text x="${60 + 520 * part}" y="345" text-anchor="middle">${markOf(left + part * (right - left))}</text>` +
        `<text x="52" y="${36 + 290 * part}" text-anchor="end">${(high - part * (high - low)).toFixed(2)}</text>`);
    return { x, y, marks: marks.join("") };
}

function lineOf(rows, colour, { x, y }) {
    const points = rows.map((row) => `${x(row)},${y(row)}`).join(" ");
    const dots = rows.map((row) => `<circle cx="${x(row)}" cy="${y(row)}" r="5"><title>${row.technique} ` +
        `${Object.entries(numbersOf(row))}: ${costOf(row).toPrecision(3)} ms, F1 ${row.f1_1px}</title></circle>`);
    return `<g fill="${colour}" stroke="${colour}"><polyline fill="none" points="${points}"/>${dots.join("")}</g>`;
}

function curveOf(rows) {
    const points = rows.filter((row) => row.outcome === "ok" && costOf(row) > 0 && row.f1_1px !== "");
    if (!points.length) return "";
    const axes = axesOf(points), techniques = [...new Set(points.map((row) => row.technique))].sort();
    const lines = techniques.map((technique, i) => {
        const own = points.filter((row) => row.technique === technique).sort((a, b) => numberOf(a) - numberOf(b));
        return lineOf(own, palette[i], axes);
    });
    return `<svg viewBox="0 0 600 385" font-size="16" fill="currentColor" role="img" aria-label="F1 over milliseconds">` +
        `<path d="M60 30V320H580" fill="none" stroke="currentColor"/>${axes.marks}<text x="320" y="375" ` +
        `text-anchor="middle">trace and structures, ms</text><text x="60" y="18">F1</text>${lines.join("")}</svg>` +
        `<p>${swatches(techniques.map((technique, i) => [technique, palette[i]]))}</p>`;
}

function showCurve() {
    const chosen = (row) => row.scene === element("scene").value && row.surface === element("surface").value;
    const own = page.measured.filter(chosen);
    element("curve").innerHTML = curveOf(own.length ? own : recorded.rows.filter(chosen));
    const device = JSON.parse(DATA.recorded["environment.json"]).identity.device;
    element("source").textContent = own.length ? `Measured here, on ${page.device.name}.`
                                               : `Recorded by ssrlab on ${device}, not on this GPU.`;
}

// ---- The sweep
async function measureRow(row) {
    const rays = await raysOf(row.scene);
    const prepared = await prepare(page.device, frameOf(row.scene, row.technique, row.surface), rays, numbersOf(row));
    const hits = (await traceFrame(page.device, prepared)).subarray(0, rays.length / 4);
    const structures = await measure(page.device, prepared.structures), trace = await measure(page.device, prepared.trace);
    release(prepared);
    return measuredRow(row, { structures, trace }, countOf(hits, 1) / (rays.length / 8));
}

function offer(name, type, text) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type }));
    link.download = link.textContent = name;
    element("downloads").append(link);
}

async function sweep() {
    page.measured = [];
    page.stopping = false;
    element("downloads").textContent = "";
    element("sweep").disabled = true;
    element("stop").hidden = false;
    const rows = recorded.rows.filter((row) => row.outcome === "ok");
    for (const [i, row] of rows.entries()) {
        if (page.stopping) break;
        element("progress").textContent = `${i + 1} of ${rows.length}: ${row.scene}, ${row.technique}`;
        page.measured.push(await measureRow(row));
        showCurve();
    }
    element("progress").textContent =
        `${page.measured.length} of ${rows.length} settings measured. Put both files into one folder: ssrlab plot FOLDER`;
    element("sweep").disabled = false;
    element("stop").hidden = true;
    offer("results.csv", "text/csv", toCsv(recorded.header, page.measured));
    offer("environment.json", "application/json", environmentOf(page.device));
}

// ---- Controls
function showNumber() {
    const [name, values] = Object.entries(DATA.swept[element("technique").value])[0] ?? [];
    element("number_label").hidden = !name;
    element("number_label").style.display = name ? "" : "none";
    if (!name) return;
    element("number_name").textContent = name;
    const input = element("number");
    Object.assign(input, { min: 0, max: values.length - 1, step: 1 });
    element("number_value").textContent = values[input.value];
}

function chosenNumbers() {
    const entry = Object.entries(DATA.swept[element("technique").value])[0];
    return entry ? { [entry[0]]: entry[1][element("number").value] } : {};
}

/// Traces what is chosen; what was chosen meanwhile is drawn instead.
async function show() {
    showNumber();
    showCurve();
    if (!page.device) return;
    const turn = ++page.drawn, [scene, technique, surface] = ["scene", "technique", "surface"].map((id) => element(id).value);
    const numbers = chosenNumbers();
    page.dda[scene + surface] ??= trace(scene, "dda", surface, {});
    const [traced, dda] = [await trace(scene, technique, surface, numbers), (await page.dda[scene + surface]).hits];
    if (turn !== page.drawn) return;
    const isChosen = (one) => Object.entries(numbers).every(([name, value]) => Number(one[name]) === value);
    const row = rowsOf(scene, technique, surface).find(isChosen);
    showFacts(traced, dda, row);
    await draw(traced, dda, scene, element("view").value);
    element("picture").dataset.shown = [scene, technique, surface, JSON.stringify(numbers)].join(" ");
}

function fail(error) {
    element("device").textContent = `It stopped: ${error.message}`;
    console.error(error);
}

async function start() {
    const fill = (id, names) => element(id).replaceChildren(...names.map((name) => new Option(name)));
    const [first] = Object.values(DATA.frames);
    fill("scene", Object.keys(DATA.frames));
    fill("technique", Object.keys(first));
    fill("surface", Object.keys(Object.values(first)[0]));
    element("number").value = 3;
    element("settings").addEventListener("input", () => show().catch(fail));
    element("sweep").addEventListener("click", () => sweep().catch(fail));
    element("stop").addEventListener("click", () => { page.stopping = true; });
    try {
        page.device = await openDevice();
        element("device").textContent = `GPU: ${page.device.name}.`;
        page.device.addEventListener("uncapturederror", (event) => fail(event.error));
    } catch (error) {
        element("device").textContent = `No tracing here: ${error.message}. The curve shows recorded results.`;
        element("sweep").disabled = true;
        const canvas = element("picture"), lit = await litImage(element("scene").value);
        [canvas.width, canvas.height] = [lit.width, lit.height];
        canvas.getContext("2d").drawImage(lit, 0, 0);
    }
    await show();
}
start().catch(fail);
