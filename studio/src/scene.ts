// The court and the hoop in three dimensions, with the paths of simulated shots. Coordinates are the
// engine's: from the hoop's centre to midcourt, to the right facing the hoop, upwards; metres.

import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { CourtLines, Hoop } from "./api";

/** The path of a ball: seconds, and metres. */
export type Path = [number, number, number, number][];

/** A ball of the first colour or of the second. */
export interface Ball {
  isSecond: boolean;
  path: Path;
}

export interface Colours {
  balls: [string, string];
  floor: string;
  line: string;
  background: string;
}

/** Seconds between the end of the last shot and the next round. */
const REST = 0.8;

const arc = (x: number, radius: number, from: number, to: number, z: number): THREE.Vector3[] =>
  Array.from({ length: 65 }, (_, i) => {
    const angle = from + ((to - from) * i) / 64;
    return new THREE.Vector3(x + radius * Math.cos(angle), radius * Math.sin(angle), z);
  });

/** Milliseconds between pictures while software renders and numbers are computed. */
const BUSY_PAUSE = 1000;

function isSoftware(): boolean {
  const probe = document.createElement("canvas").getContext("webgl2");
  const info = probe?.getExtension("WEBGL_debug_renderer_info");
  const name: unknown = info && probe?.getParameter(info.UNMASKED_RENDERER_WEBGL);
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  return typeof name === "string" && /swiftshader|llvmpipe|software|basic render/i.test(name);
}

export class CourtScene {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(38, 1, 0.25, 120);
  private readonly controls: OrbitControls;
  private readonly ground = new THREE.Group();
  private readonly swarm = new THREE.Group();
  private balls: THREE.InstancedMesh | null = null;
  private shots: Ball[] = [];
  private longest = 1;
  private shooter = new THREE.Vector3(4.2, 0, -0.9);
  private hoop: Hoop | null = null;
  private frame = 0;
  private last = 0;
  private time = 0;
  private isPlaying = false;
  private rate = 1;
  private isDirty = true;
  /** Without a graphics card pictures take the time of the cores that simulate. */
  private readonly isSoftware: boolean;
  private isBusy = false;
  private drawn = 0;
  private observer: ResizeObserver;
  /** Frames drawn so far. */
  frames = 0;
  onTime: (share: number) => void = () => {};

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private colours: Colours,
    /** Whether the picture must stay for a printer. */
    preserveDrawingBuffer = false,
  ) {
    this.isSoftware = isSoftware();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !this.isSoftware, preserveDrawingBuffer });
    this.setRatio();
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.maxPolarAngle = Math.PI * 0.54;
    this.controls.minDistance = 1;
    this.controls.maxDistance = 30;
    this.controls.addEventListener("change", () => this.touch());
    this.scene.add(this.ground, this.swarm);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8a7a66, 2.4));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(6, -5, 10);
    this.scene.add(sun);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(canvas.parentElement ?? canvas);
    this.resize();
    this.look("side");
    this.frame = requestAnimationFrame((now) => this.tick(now));
  }

  dispose() {
    cancelAnimationFrame(this.frame);
    this.observer.disconnect();
    this.controls.dispose();
    this.clear(this.ground);
    this.clear(this.swarm);
    this.renderer.dispose();
  }

  setColours(colours: Colours, court: CourtLines) {
    this.colours = colours;
    if (this.hoop) this.setCourt(court, this.hoop);
    this.setBalls(this.shots);
  }

  setCourt(court: CourtLines, hoop: Hoop) {
    this.hoop = hoop;
    this.clear(this.ground);
    const { colours } = this;
    this.scene.background = new THREE.Color(colours.background);
    const floor = -hoop.hoop_height_m;
    const far = court.half_line_x_m;
    const wide = court.half_width_m;
    const base = court.baseline_x_m;
    const plane = new THREE.Mesh(
      new THREE.PlaneGeometry(far - base + 1.6, 2 * wide + 1.6),
      new THREE.MeshLambertMaterial({ color: colours.floor }),
    );
    plane.position.set((far + base) / 2, 0, floor - 0.02);
    this.ground.add(plane);
    const lane = court.lane_half_width_m;
    const turn = Math.atan2(court.three_corner_y_m, court.three_break_x_m);
    const point = (x: number, y: number) => new THREE.Vector3(x, y, floor);
    const lines = [
      [point(base, -wide), point(far, -wide), point(far, wide), point(base, wide), point(base, -wide)],
      [point(base, -lane), point(court.free_throw_x_m, -lane), point(court.free_throw_x_m, lane), point(base, lane)],
      arc(court.free_throw_x_m, court.circle_radius_m, -Math.PI / 2, Math.PI / 2, floor),
      arc(0, court.restricted_radius_m, -Math.PI / 2, Math.PI / 2, floor),
      [point(base, -court.three_corner_y_m), ...arc(0, court.three_radius_m, -turn, turn, floor), point(base, court.three_corner_y_m)],
    ];
    const white = new THREE.LineBasicMaterial({ color: colours.line });
    for (const line of lines) this.ground.add(new THREE.Line(new THREE.BufferGeometry().setFromPoints(line), white));
    const face = -hoop.board_distance_m;
    const board = new THREE.Mesh(
      new THREE.BoxGeometry(0.03, hoop.board_width_m, hoop.board_height_m),
      new THREE.MeshLambertMaterial({ color: 0xdfe8ee, transparent: true, opacity: 0.55, depthWrite: false }),
    );
    board.position.set(face - 0.015, 0, hoop.board_centre_height_m);
    const edges = new THREE.LineSegments(new THREE.EdgesGeometry(board.geometry), new THREE.LineBasicMaterial({ color: 0x52636f }));
    edges.position.copy(board.position);
    this.ground.add(board, edges);
    // The painted square, 24 by 18 in, with its lower line at the ring.
    const [half, high] = [0.3048, 0.4572];
    const square = [
      [-half, 0],
      [half, 0],
      [half, high],
      [-half, high],
      [-half, 0],
    ].map(([y, z]) => new THREE.Vector3(face + 0.004, y!, z!));
    this.ground.add(new THREE.Line(new THREE.BufferGeometry().setFromPoints(square), new THREE.LineBasicMaterial({ color: 0x52636f })));
    const orange = new THREE.MeshLambertMaterial({ color: 0xe0501b });
    this.ground.add(new THREE.Mesh(new THREE.TorusGeometry(hoop.ring_radius_m, 0.009, 10, 56), orange));
    const reach = hoop.board_distance_m - hoop.ring_radius_m;
    const bracket = new THREE.Mesh(new THREE.BoxGeometry(reach, hoop.bracket_width_m, 0.02), orange);
    bracket.position.set(-hoop.ring_radius_m - reach / 2, 0, 0);
    this.ground.add(bracket);
    this.ground.add(this.net(hoop.ring_radius_m));
    const pole = new THREE.Mesh(
      new THREE.BoxGeometry(0.16, 0.16, hoop.hoop_height_m + 0.2),
      new THREE.MeshLambertMaterial({ color: 0x7d8a93 }),
    );
    pole.position.set(face - 0.75, 0, floor + (hoop.hoop_height_m + 0.2) / 2);
    const arm = new THREE.Mesh(new THREE.BoxGeometry(0.7, 0.1, 0.1), pole.material);
    arm.position.set(face - 0.38, 0, 0.15);
    this.ground.add(pole, arm);
    this.touch();
  }

  private net(radius: number): THREE.LineSegments {
    const strands = 12;
    const rows = 5;
    const at = (row: number, step: number) => {
      const r = radius * (1 - 0.42 * Math.sqrt(row / rows));
      const angle = ((step + (row % 2) / 2) * 2 * Math.PI) / strands;
      return new THREE.Vector3(r * Math.cos(angle), r * Math.sin(angle), -0.42 * (row / rows));
    };
    const points: THREE.Vector3[] = [];
    for (let row = 0; row < rows; row++) {
      for (let step = 0; step < strands; step++) {
        const shift = row % 2;
        points.push(at(row, step), at(row + 1, step - 1 + shift), at(row, step), at(row + 1, step + shift));
      }
    }
    const material = new THREE.LineBasicMaterial({ color: this.colours.line, transparent: true, opacity: 0.45 });
    return new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(points), material);
  }

  setBalls(shots: Ball[]) {
    this.shots = shots;
    this.clear(this.swarm);
    this.balls = null;
    this.longest = Math.max(0.5, ...shots.map((shot) => shot.path.at(-1)?.[0] ?? 0));
    if (shots.length === 0 || !this.hoop) return this.touch();
    // All paths of a kind are one geometry: few draw calls, so that software rendering keeps up.
    for (const isSecond of [true, false]) {
      const points: number[] = [];
      for (const shot of shots.filter((shot) => shot.isSecond === isSecond)) {
        for (let i = 1; i < shot.path.length; i++) {
          points.push(...shot.path[i - 1]!.slice(1), ...shot.path[i]!.slice(1));
        }
      }
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
      // Many paths are a cloud; a few are lines to look at.
      const opacity = shots.length > 10 ? 0.32 : 0.95;
      const material = new THREE.LineBasicMaterial({ color: this.colour(isSecond), transparent: true, opacity, depthWrite: false });
      this.swarm.add(new THREE.LineSegments(geometry, material));
    }
    const ball = new THREE.SphereGeometry(this.hoop.ball_radius_m, 20, 14);
    this.balls = new THREE.InstancedMesh(ball, new THREE.MeshLambertMaterial(), shots.length);
    shots.forEach((shot, i) => this.balls!.setColorAt(i, this.colour(shot.isSecond)));
    this.swarm.add(this.balls);
    this.place();
  }

  private colour(isSecond: boolean): THREE.Color {
    return new THREE.Color(this.colours.balls[isSecond ? 1 : 0]);
  }

  setShooter(x: number, y: number, heightAboveFloor: number) {
    const height = this.hoop?.hoop_height_m ?? 3.05;
    this.shooter.set(x, y, heightAboveFloor - height);
    this.touch();
  }

  /** Turns to one of the usual views. */
  look(from: "side" | "shooter" | "above" | "hoop") {
    const { x, y, z } = this.shooter;
    const reach = Math.max(3, Math.hypot(x, y));
    const across = new THREE.Vector3(-y, x, 0).normalize();
    const along = new THREE.Vector3(x, y, 0).normalize();
    const middle = new THREE.Vector3(x, y, 0).multiplyScalar(0.42).setZ(0.15);
    if (from === "side") {
      const away = across.multiplyScalar(reach * 1.42 + 1.1).add(along.multiplyScalar(0.9)).setZ(0.9);
      this.camera.position.copy(middle).add(away);
      this.controls.target.copy(middle);
    } else if (from === "shooter") {
      this.camera.position.set(x, y, z + 0.45).add(along.multiplyScalar(2.1));
      this.controls.target.set(0, 0, 0.3);
    } else if (from === "hoop") {
      this.camera.position.set(1.5, 1.1, 0.9);
      this.controls.target.set(-0.1, 0, 0.05);
    } else {
      this.camera.position.copy(middle).setZ(reach * 2.3 + 3.4).add(along.multiplyScalar(0.01));
      this.controls.target.copy(middle).setZ(-2);
    }
    this.controls.update();
    this.touch();
  }

  /** Turns by keys: right and up in radians, nearer by a factor. */
  turn(right: number, up: number, nearer = 1) {
    const away = this.camera.position.clone().sub(this.controls.target);
    const sphere = new THREE.Spherical().setFromVector3(new THREE.Vector3(away.x, away.z, -away.y));
    sphere.theta += right;
    sphere.phi = Math.min(Math.PI * 0.54, Math.max(0.05, sphere.phi - up));
    sphere.radius = Math.min(30, Math.max(1, sphere.radius / nearer));
    const turned = new THREE.Vector3().setFromSpherical(sphere);
    this.camera.position.copy(this.controls.target).add(new THREE.Vector3(turned.x, -turned.z, turned.y));
    this.controls.update();
    this.touch();
  }

  play(isPlaying: boolean, rate = this.rate) {
    this.isPlaying = isPlaying;
    this.rate = rate;
    this.setRatio();
    this.resize();
    this.touch();
  }

  /** While numbers are computed, software rendering steps back. */
  setBusy(isBusy: boolean) {
    this.isBusy = isBusy;
  }

  /** The time of the flight, as a share of the longest one. */
  seek(share: number) {
    this.time = share * this.longest;
    this.place();
  }

  picture(): string {
    this.renderer.render(this.scene, this.camera);
    return this.canvas.toDataURL("image/png");
  }

  /** Without a graphics card moving pictures are coarse and still ones fine. */
  private setRatio() {
    const ratio = this.isPlaying ? 0.75 : 2;
    this.renderer.setPixelRatio(this.isSoftware ? ratio : Math.min(devicePixelRatio, 2));
  }

  private touch() {
    this.isDirty = true;
  }

  private clear(group: THREE.Group) {
    for (const child of [...group.children]) {
      group.remove(child);
      const mesh = child as THREE.Mesh;
      mesh.geometry?.dispose();
      const materials = Array.isArray(mesh.material) ? mesh.material : [mesh.material];
      for (const material of materials) material?.dispose();
    }
  }

  private resize() {
    const box = (this.canvas.parentElement ?? this.canvas).getBoundingClientRect();
    const [width, height] = [Math.max(1, box.width), Math.max(1, box.height)];
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // A narrow window sees as much from side to side as a square one.
    this.camera.fov = width < height ? 2 * Math.atan(Math.tan((19 * Math.PI) / 180) * (height / width)) * (180 / Math.PI) : 38;
    this.camera.updateProjectionMatrix();
    this.touch();
  }

  /** Puts each ball where it is now. */
  private place() {
    if (!this.balls) return this.touch();
    const matrix = new THREE.Matrix4();
    this.shots.forEach(({ path }, index) => {
      const time = Math.min(this.time, path.at(-1)![0]);
      let i = 1;
      while (i < path.length - 1 && path[i]![0] < time) i++;
      const [before, after] = [path[i - 1]!, path[i] ?? path[i - 1]!];
      const share = after[0] > before[0] ? (time - before[0]) / (after[0] - before[0]) : 0;
      const at = (k: 1 | 2 | 3) => before[k] + share * (after[k] - before[k]);
      matrix.makeTranslation(at(1), at(2), at(3));
      this.balls!.setMatrixAt(index, matrix);
    });
    this.balls.instanceMatrix.needsUpdate = true;
    this.balls.computeBoundingSphere();
    this.touch();
  }

  private tick(now: number) {
    const passed = Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    if (this.isPlaying && this.shots.length > 0) {
      this.time += passed * this.rate;
      if (this.time > this.longest + REST) this.time = 0;
      this.place();
      this.onTime(Math.min(1, this.time / this.longest));
    }
    if (this.isDirty && !(this.isSoftware && this.isBusy && now - this.drawn < BUSY_PAUSE)) {
      this.isDirty = false;
      this.drawn = now;
      this.renderer.render(this.scene, this.camera);
      this.frames++;
    }
    this.frame = requestAnimationFrame((next) => this.tick(next));
  }
}
