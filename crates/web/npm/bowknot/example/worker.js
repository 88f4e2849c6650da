// Simulates what the page gives, and sends the cloth's positions after each time step.
import init, { Scene, Simulator } from "../bowknot.js";

const TEXT = `
[simulation]
dt = 0.0166667

[contact]
preset = "quick"

[[body]]
name = "cloth"
mesh = "plane"
translate = [0.02, 0.01, 0.6]
friction = 0.3

[[obstacle]]
name = "ball"
translate = [0.0, 0.0, 0.25]
friction = 0.3
shape = { type = "ball", radius = 0.25, edge = 0.03 }

[[obstacle]]
name = "ground"
shape = "half-space"
friction = 0.5
`;

/** Does something, and tells the page what is wrong. */
async function guarded(action) {
    try {
        await action();
    } catch (error) {
        postMessage({ error: error.message });
    }
}

onmessage = ({ data: plane }) =>
    guarded(async () => {
        await init();
        const simulator = new Simulator(Scene.fromToml(TEXT, { plane }));
        const count = plane.positions.length;
        // For each vertex of the plane its number in the simulation, should any be left out.
        const order = simulator.meshOrder("cloth");
        const tick = () => {
            const began = performance.now();
            simulator.step();
            const all = simulator.positions;
            const positions = new Float32Array(count);
            order.forEach((v, k) => v >= 0 && positions.set(all.subarray(3 * v, 3 * v + 3), 3 * k));
            postMessage({ positions, frame: simulator.stepIndex, intersections: simulator.check().count }, [positions.buffer]);
            setTimeout(() => guarded(tick), Math.max(0, 1000 * simulator.timeStep - (performance.now() - began)));
        };
        tick();
    });
