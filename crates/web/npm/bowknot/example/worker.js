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

onmessage = async ({ data: plane }) => {
    try {
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
            order.forEach((v, k) => positions.set(all.subarray(3 * v, 3 * v + 3), 3 * k));
            postMessage({ positions, frame: simulator.stepIndex, intersections: simulator.check().count }, [positions.buffer]);
            setTimeout(tick, Math.max(0, 1000 * simulator.timeStep - (performance.now() - began)));
        };
        tick();
    } catch (error) {
        postMessage({ error: error.message });
    }
};
