/**
 * What the page's parts share: main.js makes it, and each panel is given it.
 *
 * @typedef {import('./protocol.js').Pose} Pose
 * @typedef {import('./protocol.js').Role} Role
 * @typedef {import('./protocol.js').Policy} Policy
 * @typedef {import('./protocol.js').Unit} Unit
 * @typedef {import('./protocol.js').Line} Line
 * @typedef {import('./protocol.js').Questions} Questions
 * @typedef {import('./protocol.js').BodyFacts} BodyFacts
 * @typedef {import('./protocol.js').TreeFacts} TreeFacts
 * @typedef {import('./protocol.js').Tick} Tick
 * @typedef {import('./protocol.js').Bite} Bite
 */

/**
 * @typedef {object} State
 * @property {{fixed: BodyFacts | null, moving: BodyFacts | null}} bodies
 * @property {number | null} jaws   the seed of the built-in jaws, where both bodies are those
 * @property {Trees | null} trees   null until both bodies have trees
 * @property {Pose} pose            of the moving body
 * @property {Pose} home            the pose that the bodies came with: the closing slider's 0
 * @property {import('./facing.js').Facing} facing  how both bodies face each other at the home pose
 * @property {boolean} dragging     whether the pose changes right now
 * @property {number | null} voxelSize  mesh units; null: the engine's own choice
 * @property {Policy | null} policy     null: the tightest
 * @property {number} stiffness     N/mm³
 * @property {Tick | null} tick     the answer at the pose, or at one a few frames ago
 * @property {Answer | null} answer the command's answer at `answer.pose`, where the pose rested last
 * @property {{pose: Pose, policy: Policy | null} | null} cancelled  where somebody cancelled the answer: it is not known there
 * @property {BiteAt | null} bite   the map, at the pose where it was made
 * @property {string} preset
 * @property {number} reach         millimetres
 * @property {Unit | null} unit     of both bodies, where their files name none
 * @property {Unit | null} fileUnit of the files that are opened next; null: as each says itself
 * @property {string} frame         "lps", "ras" or ""
 * @property {boolean} wantsMap     whether the map is made again where the pose rests
 * @property {boolean} book         whether both bodies are drawn opened like a book
 * @property {'dark' | 'light' | null} theme  null: as the system says
 * @property {string} panel         id of the panel that is shown
 * @property {number} seed
 *
 * @typedef {{fixed: TreeFacts, moving: TreeFacts, policies: Policy[]}} Trees
 * @typedef {{header: Line, line: Line, microseconds: number, pose: Pose, policy: Policy | null}} Answer
 * @typedef {Bite & {pose: Pose}} BiteAt
 */

/**
 * @typedef {object} Store
 * @property {() => Readonly<State>} get
 * @property {(change: Partial<State>) => void} set  calls those who subscribed to a key that changed
 * @property {(keys: (keyof State)[], listen: (state: Readonly<State>) => void) => () => void} subscribe
 *   returns what ends the subscription
 */

/**
 * @typedef {object} Context
 * @property {import('./engine/engine_client.js').EngineClient} engine
 * @property {import('./engine/engine_client.js').EngineClient} measurer  another engine, for what takes seconds and needs no trees: a hand that drags does not wait for it
 * @property {Store} store
 * @property {import('./view/stage.js').Stage} stage
 * @property {import('./bodies_loader.js').BodiesLoader} loader
 * @property {import('./state/pose_history.js').PoseHistory} history
 * @property {(text: string, kind?: 'note' | 'warning' | 'error') => void} say
 * @property {import('./recording/read_recording.js').ReadRecording} readRecording
 */

/**
 * @typedef {object} Panel
 * @property {string} id        of the fragment and the tab
 * @property {string} title
 * @property {HTMLElement} element
 * @property {() => void} shown   the panel is seen now
 * @property {() => void} hidden  it is no more: it takes its marks off the stage
 */
/** @typedef {(context: Context) => Panel} MakePanel */

export {};
