// Traces baked frames by run.js, times them, and writes rows as ssrlab run does.
"use strict";

const unpacked = new Map();

/// A file of the page by its name there.
async function blob(name) {
    if (!unpacked.has(name)) {
        const bytes = Uint8Array.from(atob(DATA.blobs[name]), (letter) => letter.charCodeAt(0));
        const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
        unpacked.set(name, new Response(stream).arrayBuffer());
    }
    return unpacked.get(name);
}
const readBlob = (path) => blob(path.replace("frames/", ""));
const pipelines = new Map();

/// The pipeline of a pass with numbers in the place of its overrides.
async function pipelineOf(device, file, numbers) {
    const key = file + JSON.stringify(numbers);
    if (!pipelines.has(key)) {
        const code = new TextDecoder().decode(await blob(file)), constants = {};
        for (const [name, value] of Object.entries(numbers)) {
            const id = code.match(new RegExp(`@id\\((\\d+)\\) override ${name}(_\\d+)?:`));
            if (id) constants[id[1]] = value;
        }
        pipelines.set(key, makePipeline(device, code, file, constants));
    }
    return pipelines.get(key);
}

/// Rays of the frame in the order of pixels: what the ray set-up makes, at the pixels that reflect.
async function makeRays(device, frame) {
    const resources = await makeResources(device, frame, readBlob);
    const steps = await makeSteps(device, frame, resources, (file) => pipelineOf(device, file, {}));
    const setUp = frame.passes.findIndex((pass) => Object.values(pass.bindings).includes("made_rays"));
    const encoder = device.createCommandEncoder();
    encodeSteps(encoder, steps.filter((step) => frame.passes.findIndex((pass) => pass.file === step.file) <= setUp));
    device.queue.submit([encoder.finish()]);
    const [made, count] = [await readBuffer(device, resources.made_rays), await readBuffer(device, resources.made_count)];
    const mask = new Uint8Array(await blob(frame.mask));
    const reflects = (ray) => {
        const at = ((made[8 * ray + 7] >>> 14) & 0x3fff) * frame.size_px[0] + (made[8 * ray + 7] & 0x3fff);
        return (mask[at >> 3] >> (at & 7)) & 1;
    };
    const order = Array.from({ length: count[0] }, (_, ray) => ray).filter(reflects);
    order.sort((a, b) => (made[8 * a + 7] & 0xfffffff) - (made[8 * b + 7] & 0xfffffff));
    const rays = new Uint32Array(8 * order.length);
    order.forEach((ray, place) => rays.set(made.subarray(8 * ray, 8 * ray + 8), 8 * place));
    for (const resource of Object.values(resources)) resource.destroy();
    return rays;
}

/// Ready to run: resources on the GPU, the step that lays out depth, those of the structures, and that of the trace.
async function prepare(device, frame, rays, numbers) {
    const resources = await makeResources(device, frame, readBlob);
    device.queue.writeBuffer(resources.rays, 0, rays);
    device.queue.writeBuffer(resources.ray_count, 0, new Uint32Array([rays.length / 8]));
    const passes = frame.passes.filter((pass) => !Object.values(pass.bindings).includes("made_rays"));
    const steps = await makeSteps(device, { passes }, resources, (file) => pipelineOf(device, file, numbers));
    return { resources, layout: steps.slice(0, 1), structures: steps.slice(1, -1), trace: steps.slice(-1) };
}

async function traceFrame(device, prepared) {
    const encoder = device.createCommandEncoder();
    encodeSteps(encoder, [...prepared.layout, ...prepared.structures, ...prepared.trace]);
    device.queue.submit([encoder.finish()]);
    return readBuffer(device, prepared.resources.hits);
}

function release(prepared) {
    for (const resource of Object.values(prepared.resources)) resource.destroy();
}

/// Milliseconds of `times` repetitions: by timestamps of the GPU, else by the clock around a submission and its fence.
async function timeOnce(device, steps, times) {
    const repeated = Array.from({ length: times }, () => steps).flat();
    const encoder = device.createCommandEncoder();
    if (!device.features.has("timestamp-query")) {
        encodeSteps(encoder, repeated);
        await device.queue.onSubmittedWorkDone();
        const begun = performance.now();
        device.queue.submit([encoder.finish()]);
        await device.queue.onSubmittedWorkDone();
        return performance.now() - begun;
    }
    const querySet = device.createQuerySet({ type: "timestamp", count: 2 });
    const resolved = device.createBuffer({ size: 16, usage: GPUBufferUsage.QUERY_RESOLVE | GPUBufferUsage.COPY_SRC });
    encodeSteps(encoder, repeated, { querySet, beginningOfPassWriteIndex: 0, endOfPassWriteIndex: 1 });
    encoder.resolveQuerySet(querySet, 0, 2, resolved, 0);
    device.queue.submit([encoder.finish()]);
    const [begin, end] = new BigUint64Array((await readBuffer(device, resolved)).buffer);
    querySet.destroy();
    resolved.destroy();
    return Number(end - begin) / 1e6;
}

const median = (values) => {
    const sorted = [...values].sort((a, b) => a - b), middle = sorted.length >> 1;
    return sorted.length % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
};

/// Median and median deviation of one repetition. Browsers round timestamps to 0.1 ms, so each sample lasts 10 ms or more.
async function measure(device, steps, samples = 7) {
    if (!steps.length) return { ms: 0, mad: 0, samples, times: 1 };
    let times = 1, spent = await timeOnce(device, steps, 1);
    while (spent < 10 && times < 512) spent = await timeOnce(device, steps, times *= 2);
    const each = [];
    for (let i = 0; i < samples; ++i) each.push((await timeOnce(device, steps, times)) / times);
    const middle = median(each);
    return { ms: middle, mad: median(each.map((one) => Math.abs(one - middle))), samples, times };
}

// ---- Tables
function fieldsOf(line) {
    const fields = [];
    for (const [, quoted, plain] of line.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^,]*))/g))
        fields.push(quoted === undefined ? plain : quoted.replaceAll('""', '"'));
    return fields;
}

function parseCsv(text) {
    const [header, ...lines] = text.trim().split("\n").map(fieldsOf);
    return { header, rows: lines.map((fields) => Object.fromEntries(header.map((name, i) => [name, fields[i] ?? ""]))) };
}

const asField = (value) => (/[",\n]/.test(value) ? `"${String(value).replaceAll('"', '""')}"` : value);

const ofTime = /(^|[_.])ms(_|$)|^(fps|inverse_fps_s|trace_drift|frames_per_submit|repeats)$/;

/// The recorded row with the times of this GPU, and without those of the device that recorded it.
function measuredRow(recorded, times, hitShare) {
    const row = { ...recorded, run_id: "w" + recorded.run_id.slice(1), experiment: "web", picture: "", truth_picture: "" };
    for (const name of Object.keys(row)) if (ofTime.test(name)) row[name] = "";
    row.trace_ms_median = times.trace.ms;
    row.trace_ms_mad = times.trace.mad;
    row.structures_ms_median = times.structures.ms;
    row.repeats = times.trace.samples;
    row.frames_per_submit = times.trace.times;
    if (Math.abs(hitShare - Number(recorded.hit_share)) > 1e-3) {
        row.outcome = "failed";
        row.message = `${hitShare.toFixed(4)} of the rays hit; recorded: ${recorded.hit_share}`;
    }
    return row;
}

function toCsv(header, rows) {
    return [header, ...rows.map((row) => header.map((name) => row[name]))]
        .map((line) => line.map(asField).join(",") + "\n").join("");
}

function environmentOf(device) {
    const environment = JSON.parse(DATA.recorded["environment.json"]);
    delete environment.samples;
    return JSON.stringify({
        ...environment, device: device.name, device_type: "WebGPU", driver: navigator.userAgent,
        started: new Date().toISOString(), command_line: "experiments/web, measured by the page", title: "Measured by the page",
        identity: { ...environment.identity, device: device.name, driver: navigator.userAgent, processor: "" },
        times: "of this device, by " +
            (device.features.has("timestamp-query") ? "timestamps" : "the clock around repeated dispatches") +
            "; all other columns were recorded by ssrlab on the same frames",
    }, null, 1);
}
