// Draws with three.js what a worker simulates: a cloth that is a PlaneGeometry falls on a ball that is a SphereGeometry.
import * as THREE from "three";

const canvas = document.getElementById("canvas");
const words = document.getElementById("words");
const renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
const scene = new THREE.Scene();
scene.background = new THREE.Color(0x1b212a);
const camera = new THREE.PerspectiveCamera(35, 1, 0.01, 20);
// Bowknot's z is up; so is the camera's here.
camera.up.set(0, 0, 1);
camera.position.set(1.3, -1.9, 1.2);
camera.lookAt(0, 0, 0.25);
scene.add(new THREE.HemisphereLight(0xffffff, 0x445566, 2));
const sun = new THREE.DirectionalLight(0xffffff, 2);
sun.position.set(-1, -1, 2);
scene.add(sun);

const plane = new THREE.PlaneGeometry(1, 1, 32, 32);
const cloth = new THREE.Mesh(plane, new THREE.MeshStandardMaterial({ color: 0x4c93d9, side: THREE.DoubleSide }));
cloth.frustumCulled = false;
const ball = new THREE.Mesh(new THREE.SphereGeometry(0.25, 48, 24), new THREE.MeshStandardMaterial({ color: 0x8d97a6 }));
ball.position.z = 0.25;
scene.add(cloth, ball);

// The plane's vertices are those of the simulation: positions are copied as they are.
const mesh = { positions: Float64Array.from(plane.attributes.position.array), triangles: Uint32Array.from(plane.index.array) };
const worker = new Worker("worker.js", { type: "module" });
worker.onerror = (event) => (words.textContent = `The worker could not be loaded: ${event.message ?? ""}`);
worker.onmessage = ({ data: { error, positions, frame, intersections } }) => {
    if (error) return (words.textContent = error);
    plane.attributes.position.array.set(positions);
    plane.attributes.position.needsUpdate = true;
    plane.computeVertexNormals();
    words.textContent = `frame ${frame}, ${intersections} intersections`;
    document.body.dataset.frame = String(frame);
    document.body.dataset.intersections = String(intersections);
};
worker.postMessage(mesh);

renderer.setAnimationLoop(() => {
    const { clientWidth: width, clientHeight: height } = canvas;
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    renderer.render(scene, camera);
});
