// A scene around a mesh of a file.

/** Width of the mesh, once it is scaled [m]. */
const WIDTH = 0.6;

/** The text of a scene: a sheet falls on the mesh, or the mesh, as cloth, on a ball. Its box is from `low` to `high`. */
export function sceneWith(name, role, low, high) {
    const size = high.map((top, k) => top - low[k]);
    const scale = WIDTH / Math.max(...size, 1e-30);
    const middle = low.map((bottom, k) => 0.5 * (bottom + high[k]));
    const lift = role === "obstacle" ? 0.02 : 0.7;
    const translate = [-scale * middle[0], -scale * middle[1], lift - scale * low[2]];
    const mesh = `mesh = ${JSON.stringify(name)}\nscale = ${scale}\ntranslate = [${translate.join(", ")}]\nfriction = 0.3`;
    const ground = '[[obstacle]]\nname = "ground"\nshape = "half-space"\nfriction = 0.5';
    const above = lift + scale * size[2] + 0.05;
    const parts = role === "obstacle"
        ? [
            `[[body]]\nname = "sheet"\nfriction = 0.3\ntranslate = [0.0, 0.0, ${above}]\n[body.shape]\ntype = "sheet"\nsize = [1.0, 1.0]\nedge = 0.025`,
            `[[obstacle]]\nname = "your mesh"\n${mesh}`,
        ]
        : [
            `[[body]]\nname = "your mesh"\n${mesh}`,
            '[[obstacle]]\nname = "ball"\nfriction = 0.3\ntranslate = [0.02, 0.01, 0.25]\n[obstacle.shape]\ntype = "ball"\nradius = 0.25\nedge = 0.04',
        ];
    return [...parts, ground].join("\n\n");
}
