/** A mesh: the text or the bytes of a file, whose format its name tells (OBJ, PLY, STL, MSH, MESH, VTU), or arrays. */
export type MeshSource = string | Uint8Array | MeshArrays;

/** A mesh by its arrays; indices count from 0. Without elements each point is a particle. */
export interface MeshArrays {
    /** x y z of each vertex [m]. */
    positions: Float64Array | Float32Array | number[];
    triangles?: Uint32Array | Uint16Array | number[];
    tets?: Uint32Array | Uint16Array | number[];
    /** Edges of strands. */
    edges?: Uint32Array | Uint16Array | number[];
}

export interface BuiltinScene {
    name: string;
    summary: string;
}

/** A body or an obstacle with a mesh: its vertices are those from `start` to before `end`. */
export interface BodyInfo {
    name: string;
    kind: "cloth" | "solid" | "strands" | "particles" | "obstacle";
    start: number;
    end: number;
}

/** What a time step did; lengths in m, times in s. There are more fields: those of `stats.jsonl` of a run. */
export interface StepStatistics {
    step: number;
    time: number;
    newton_iterations: number;
    two_way_steps: number;
    converged: boolean;
    min_gap_m: number | null;
    max_stretch: number;
    max_speed: number;
    [field: string]: unknown;
}

/** What the judge says of a state. */
export interface Verdict {
    /** How many pairs intersect. */
    count: number;
    /** The first of them, in words. */
    intersections: string[];
}

/** What collides, for a Resolver. Only `rest` is needed. */
export interface ResolverOptions {
    /** x y z of each vertex at rest [m]: default lengths and stretch limits follow from it. */
    rest: Float64Array | number[];
    triangles?: Uint32Array | number[];
    /** Edges of strands. Edges of triangles are not listed. */
    edges?: Uint32Array | number[];
    /** Vertices that are particles. */
    particles?: Uint32Array | number[];
    /** Mass of all vertices or of each [kg]. Default 1. */
    masses?: number | Float64Array | number[];
    /** Vertices that go to their targets and yield to nothing, as pins do. */
    fixed?: Uint8Array | boolean[];
    /** The body of each vertex. Default: 0, and 1 for obstacles. */
    bodies?: Uint32Array | number[];
    /** Vertices of obstacles, whole bodies of them. */
    obstacles?: Uint8Array | boolean[];
    /** Half-spaces that everything stays above: normal and offset [m] of each, four numbers. */
    planes?: Float64Array | number[];
    /** Coefficient of friction of all bodies or of each [1]. Default 0. One number also holds for half-spaces; of a list they
     * have none. */
    friction?: number | Float64Array | number[];
    /** Guaranteed smallest gap of all bodies or of each [m]. */
    thickness?: number | Float64Array | number[];
    /** Contact distance of all bodies or of each [m]. Default: a tenth of the mean edge. */
    delta?: number | Float64Array | number[];
    /** Largest ratio of an edge's length to its rest length [1], of all bodies or of each. Default 1.1. */
    stretchLimit?: number | Float64Array | number[];
    /** Assignments to keys of `[contact]` and `[solver]`, such as `"contact.preset=quick"`. */
    sets?: string[];
}

export interface ResolveOptions {
    /** Vertices that go to their targets in this call, in place of those of the resolver. */
    fixed?: Uint8Array | boolean[];
    /** Time step that the call stands for [s], for friction and the speed at which pairs are separated. */
    timeStep?: number;
    /** Positions at the start of the time step [m], which friction measures slip from. */
    start?: Float64Array;
    /** Whether a start that the last call did not end with is judged. Default true. */
    check?: boolean;
}

/** A resolved state, and what the call did. */
export interface Resolved {
    /** x y z of each vertex [m], free of intersections. */
    positions: Float64Array;
    /** Whether everything is where it is to go, or as near as it gets. */
    converged: boolean;
    info: { steps: number; [field: string]: unknown };
}
