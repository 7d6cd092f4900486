/**
 * What the page asks the engine, and what it answers. The worker passes both on; the engine is
 * src/viewer/engine. Lengths are in mesh units. A pose maps moving mesh coordinates to fixed mesh
 * coordinates: 16 numbers, column by column, as in the command's JSON.
 *
 * @typedef {number[]} Pose
 * @typedef {'fixed' | 'moving'} Role
 * @typedef {'simple' | 'table' | 'tight' | 'slab'} Policy  from the loosest spheres to the tightest
 * @typedef {'mm' | 'm' | 'inch' | 'µm'} Unit
 * @typedef {'ras' | 'lps'} Frame  the patient's directions along x and y, as a file says them
 * @typedef {Record<string, any>} Line  an object as the command prints it
 */

/**
 * @typedef {object} BodyFacts  a body that is read; its tree may be another one later
 * @property {string} name      of its file, or of the built-in jaw
 * @property {Line} info        the second line of `ist info --json`, as of its mesh or tree
 * @property {string[]} warnings
 * @property {number} extent    the largest side of its box
 * @property {boolean} rebuilds whether it holds triangles, of which a tree can be made
 * @property {Unit | null} unit  null where neither the file nor the page names it
 * @property {Float32Array} positions of the vertices to draw, or of the surface of its voxels
 * @property {Uint32Array} triangles  three indices each
 */

/**
 * @typedef {object} TreeFacts
 * @property {number} voxel_size
 * @property {number} leaves
 * @property {number} depth       level of the root; leaves are at level 0
 * @property {number[]} nodes     by level
 * @property {number} bytes
 * @property {Policy} tightest
 * @property {boolean} closed     whether inside is certain
 * @property {number} milliseconds of the build; 0 of a tree that was read
 */

/**
 * @typedef {object} Contacts
 * @property {Float64Array} positions three numbers a contact, fixed coordinates
 * @property {Float64Array} normals   from the fixed body to the moving one
 * @property {Float64Array} depths
 * @property {Float64Array} weights   mesh units²
 * @property {number[]} force         on the moving body: stiffness · mesh units³
 * @property {number[]} torque        about `about`
 * @property {number[]} about         fixed coordinates
 */

/**
 * The questions, by name: what each takes and gives.
 *
 * @typedef {object} Questions
 * @property {[{seed: number}, {fixed: BodyFacts, moving: BodyFacts}]} make_jaws
 *   the upper jaw is fixed, the lower one moves; millimetres
 * @property {[{role: Role, name: string, bytes: ArrayBuffer, unit?: Unit, to_frame?: Frame}, BodyFacts]} open
 *   a mesh or a tree; the body of that role before is gone, but stays if this one is refused. A mesh
 *   of the other known frame is turned into `to_frame`
 * @property {[{voxel_size: number | null}, {fixed: TreeFacts, moving: TreeFacts, policies: Policy[]}]} build
 *   makes the trees of bodies that hold triangles, of this voxel size; null: a 500th of the smaller
 *   body's largest extent
 * @property {[{pose: Pose, policy?: Policy}, {header: Line, line: Line, microseconds: number}]} collide
 *   as `ist collide --json` prints them; `microseconds` is the median of groups of 20 queries or
 *   more that are timed together, above 0 by a coarse clock too
 * @property {[{pose: Pose, policy?: Policy, stiffness: number}, Tick]} tick
 *   what a frame of dragging needs, quickly
 * @property {[{from: Pose, to: Pose, tolerance: number}, {status: string, lower: number, upper: number, pose: Pose, point: number[] | null}]} first_contact
 *   along the screw from one pose to the other; `pose` is that of `upper`, and `point` lies on both bodies there
 * @property {[{role: Role, policy: Policy, level: number}, Level]} level
 * @property {[{pose: Pose, policy: Policy, level: number}, {fixed: Uint32Array, moving: Uint32Array}]} touched
 *   the nodes of that level (of the deeper tree's; the other's where it has none so deep) that
 *   overlap another, by their places in `level`
 * @property {[{pose: Pose, policy: Policy}, {steps: Step[]}]} fronts
 * @property {[{pose: Pose, policy: Policy, step: number}, Front]} front
 * @property {[{pose: Pose, frame: string}, FacingReply]} facing
 * @property {[{}, {}]} swap  gives each body the other one's role; there are no trees then
 * @property {[BiteQuestion, Bite]} occlusion
 * @property {[{role: Role}, {bytes: Uint8Array}]} save_body  its tree's file, as `ist build` writes it
 * @property {[{}, {in_use: number}]} memory  bytes that the engine holds now
 * @property {[BiteQuestion, {bytes: Uint8Array}]} save_glb  both bodies, in the colours of their map
 */

/**
 * @typedef {object} Tick
 * @property {string} touch          "unknown", "no", "near" or "yes"
 * @property {number} distance_lower
 * @property {number} distance_upper
 * @property {number} leaf_pairs
 * @property {number} sphere_tests
 * @property {number} resolution
 * @property {Contacts} contacts
 */

/**
 * @typedef {object} FacingReply  how both bodies face each other; fixed coordinates
 * @property {boolean} known       whether surfaces are near enough to tell
 * @property {number[]} [towards]  from the fixed body to the moving one; missing where a body has no triangles
 * @property {number[]} [front]    to the front teeth
 * @property {Role} [upper]        the body that lies above
 */

/**
 * @typedef {object} Level  the nodes of one level, in Morton order, fixed or moving coordinates
 * @property {Float32Array} centres  three numbers a ball
 * @property {Float32Array} radii
 * @property {Float32Array} [normals]  of slabs: three numbers each
 * @property {Float32Array} [offsets]  of a slab's middle plane from the ball's centre, along the normal
 * @property {Float32Array} [halves]   half the thickness of each slab
 */

/**
 * @typedef {object} Step  one step of a query down both trees
 * @property {number} fixed_level  of the nodes of the pairs after it
 * @property {number} moving_level
 * @property {number} tests        pairs of bounds tested
 * @property {number} pairs        those that overlap
 */

/**
 * @typedef {object} Front  the pairs of nodes after a step, by their places in `level`
 * @property {number} fixed_level
 * @property {number} moving_level
 * @property {Uint32Array} fixed   a node for each pair
 * @property {Uint32Array} moving
 */

/**
 * @typedef {object} BiteQuestion
 * @property {Pose} pose
 * @property {string} preset          "scan", "owens", "biteeye", "paper", "stl" or "shim"
 * @property {number} reach           millimetres
 * @property {Unit} [unit]            of both meshes, where their trees hold none
 * @property {string} [frame]         "lps", "ras" or ""
 */

/**
 * @typedef {object} Band  of distances above `from` to `to`
 * @property {number | null} from  null: without end
 * @property {number} to
 * @property {string} colour  "#rrggbb"
 * @property {string} words   such as "0 to 100 µm"
 * @property {boolean} below_scan_error
 */

/**
 * @typedef {object} Bite
 * @property {Line} bite          as `ist occlusion --json` prints it
 * @property {Band[]} bands
 * @property {string} bare        colour of what lies beyond the bands
 * @property {MapSide} fixed
 * @property {MapSide} moving
 * @property {Record<BookLayout, Record<Role, Pose>>} book  where the bodies lie when they are opened like a book: maps of their own
 *   coordinates to those of the picture: x to the right, z up, the viewer at −y
 *
 * @typedef {'beside' | 'above'} BookLayout  side by side, the front of both up; or the fixed body above the moving one, the fronts outwards
 */

/**
 * @typedef {object} MapSide
 * @property {Float32Array} distances  of each vertex of BodyFacts.positions; NaN beyond the reach
 */

/**
 * @template {keyof Questions} Name
 * @typedef {Questions[Name][0]} Asked
 */
/**
 * @template {keyof Questions} Name
 * @typedef {Questions[Name][1]} Answer
 */

/**
 * @typedef {{id: number, question: string, asked: object}} ToWorker
 * @typedef {{id: number, answer: object, milliseconds: number, heap?: number}
 *   | {id: number, error: {code: string, text: string}}
 *   | {id: number, progress: {stage: string, part: number}}
 *   | {ready: true, version: string, target: string}} FromWorker
 */

export {};
