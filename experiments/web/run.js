// A WebGPU host for exported passes: it reads a frame's JSON file, runs the passes that it lists, and compares.
// read(path) gives the ArrayBuffer of a file of the exported folder, text(path) its text. No other script is needed.
"use strict";

async function openDevice() {
    const adapter = await navigator.gpu?.requestAdapter({ powerPreference: "high-performance" });
    if (!adapter) throw new Error("this browser offers no WebGPU adapter");
    const limits = ["maxStorageBufferBindingSize", "maxBufferSize", "maxStorageBuffersPerShaderStage"];
    const device = await adapter.requestDevice({
        requiredFeatures: ["timestamp-query"].filter((name) => adapter.features.has(name)),
        requiredLimits: Object.fromEntries(limits.map((name) => [name, adapter.limits[name]])),
    });
    const info = adapter.info;
    device.name = info.description || [info.vendor, info.architecture, info.device].filter(Boolean).join(" ");
    return device;
}

function makeTexture(device, size, channels, words) {
    const texture = device.createTexture({
        size, format: channels === 1 ? "r32float" : "rgba32float",
        usage: GPUTextureUsage.STORAGE_BINDING | GPUTextureUsage.COPY_DST,
    });
    device.queue.writeTexture({ texture }, words, { bytesPerRow: size[0] * channels * 4 }, size);
    return texture;
}

function makeBuffer(device, bytes, words, uniform = false) {
    const usage = uniform ? GPUBufferUsage.UNIFORM : GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC;
    const buffer = device.createBuffer({ size: Math.max(bytes, 16), usage: usage | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(buffer, 0, words);
    return buffer;
}

/// Buffers and textures by their name, with what the frame's files or fill words say.
async function makeResources(device, frame, read) {
    const made = {};
    for (const [name, resource] of Object.entries(frame.resources)) {
        const words = resource.file ? new Uint32Array(await read("frames/" + resource.file))
                                    : new Uint32Array(resource.bytes / 4).fill(resource.fill);
        if (resource.kind === "r32f") made[name] = makeTexture(device, frame.size_px, 1, words);
        else if (resource.kind === "rgba32f") made[name] = makeTexture(device, frame.size_px, 4, words);
        else made[name] = makeBuffer(device, resource.bytes, words, resource.kind === "uniform");
    }
    return made;
}

async function makePipeline(device, code, label, constants = {}) {
    const module = device.createShaderModule({ code, label });
    const errors = (await module.getCompilationInfo()).messages.filter((message) => message.type === "error");
    if (errors.length) throw new Error(`${label}:${errors[0].lineNum}: ${errors[0].message}`);
    return device.createComputePipelineAsync({ layout: "auto", label, compute: { module, constants } });
}

/// The pipeline of a pass, made once for all frames and folders with the same text: compiling takes longer than running.
async function pipelineOf(device, code, label) {
    device.pipelines ??= new Map();
    if (!device.pipelines.has(code)) device.pipelines.set(code, await makePipeline(device, code, label));
    return device.pipelines.get(code);
}

/// What to encode, in order: a pipeline, its bind group and its workgroups. pipeline(file) gives that of a pass.
async function makeSteps(device, frame, resources, pipeline) {
    const steps = [];
    for (const pass of frame.passes) {
        const compiled = await pipeline(pass.file);
        for (const dispatch of pass.dispatches) {
            const entries = Object.entries(pass.bindings).map(([binding, name]) => ({
                binding: Number(binding), resource: boundResource(device, name, dispatch, resources),
            }));
            const group = device.createBindGroup({ layout: compiled.getBindGroupLayout(0), entries });
            steps.push({ file: pass.file, pipeline: compiled, group, groups: dispatch.groups });
        }
    }
    return steps;
}

function boundResource(device, name, dispatch, resources) {
    if (name === "push")
        return { buffer: makeBuffer(device, 16, new Int32Array([...dispatch.push, 0, 0]), true) };
    const resource = resources[name];
    return resource instanceof GPUTexture ? resource.createView() : { buffer: resource };
}

/// WebGPU puts a barrier between dispatches by itself.
function encodeSteps(encoder, steps, timestampWrites) {
    const pass = encoder.beginComputePass(timestampWrites ? { timestampWrites } : {});
    for (const step of steps) {
        if (step.groups.includes(0)) continue;
        pass.setPipeline(step.pipeline);
        pass.setBindGroup(0, step.group);
        pass.dispatchWorkgroups(...step.groups);
    }
    pass.end();
}

async function readBuffer(device, buffer) {
    const copy = device.createBuffer({ size: buffer.size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    const encoder = device.createCommandEncoder();
    encoder.copyBufferToBuffer(buffer, 0, copy, 0, buffer.size);
    device.queue.submit([encoder.finish()]);
    await copy.mapAsync(GPUMapMode.READ);
    const words = new Uint32Array(copy.getMappedRange().slice(0));
    copy.destroy();
    return words;
}

/// Hits of the frame's rays, and the rays that the ray set-up made where the frame has it.
async function runFrame(device, frame, read, text) {
    const resources = await makeResources(device, frame, read);
    const steps = await makeSteps(device, frame, resources, async (file) => pipelineOf(device, await text(file), file));
    const encoder = device.createCommandEncoder();
    encodeSteps(encoder, steps);
    device.queue.submit([encoder.finish()]);
    const answers = { hits: (await readBuffer(device, resources.hits)).subarray(0, 2 * frame.rays) };
    for (const name of ["made_rays", "made_count"])
        if (resources[name]) answers[name] = await readBuffer(device, resources[name]);
    for (const resource of Object.values(resources)) resource.destroy();
    return answers;
}

const hasPlace = (word) => [1, 6].includes(word >>> 28); // a hit, or stopped

/// How many rays differ, by status, by pixel, or by any bit of t.
function countDiffering(hits, expected) {
    let differing = 0;
    for (let i = 0; i < expected.length; i += 2)
        if (hits[i] !== expected[i] || (hasPlace(hits[i]) && hits[i + 1] !== expected[i + 1])) ++differing;
    return differing;
}

/// Runs these frames of an exported folder; say(line) is told of each, answered(name, answers) gets them.
async function verifyFolder(device, folder, names, say, answered = () => {}) {
    const fetched = async (path) => {
        const answer = await fetch(folder + path);
        if (!answer.ok) throw new Error(`${path}: ${answer.statusText}`);
        return answer;
    };
    const read = async (path) => (await fetched(path)).arrayBuffer();
    const text = async (path) => (await fetched(path)).text();
    device.onuncapturederror = (event) => say(`error: ${event.error.message}`);
    for (const name of names) {
        const frame = JSON.parse(await text(`frames/${name}.json`));
        const answers = await runFrame(device, frame, read, text);
        const expected = new Uint32Array(await read(`expected/${frame.expected.hits}`));
        say(`${name}: ${countDiffering(answers.hits, expected)} of ${frame.rays} rays differ`);
        await answered(name, answers);
    }
}
