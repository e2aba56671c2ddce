// The bodies and the fluoroscopes in space: sources, detectors with the pictures on them, rays; turned with the mouse.

import {
  AmbientLight, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, Group, Line, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial,
  MeshStandardMaterial, PerspectiveCamera, Scene, SphereGeometry, SRGBColorSpace, Texture, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { el, tick } from './dom.js';
import { add, norm, placed, project, recorded, scale, sub, times, unit, unproject } from './geometry.js';
import { frameOf, lookAt, models, onChange, play, state, study, verdictOf } from './study.js';

const RAYS = '#ffd34d';

export function spaceTab(host, visible) {
  const slider = el('input', { type: 'range', class: 'grow', min: 0, 'aria-label': 'frame', oninput: () => lookAt(state.trial, +slider.value) });
  const player = el('button', { type: 'button', onclick: () => play(!state.playing, () => drawn === state.frame) }, 'play');
  const label = el('b');
  const box = el('div', { id: 'scene' });
  const settings = { pictures: true, rays: true, solid: 100 };
  const looks = el('span', { class: 'bar', style: 'margin:0' });
  host.append(el('div', { class: 'bar' }, player, label, slider),
    el('div', { class: 'bar' }, looks, tick('pictures', true, (on) => { settings.pictures = on; show(); }), tick('rays', true, (on) => { settings.rays = on; show(); }),
      el('label', {}, 'solid ', el('input', { type: 'range', class: 'narrow', min: 10, max: 100, value: 100, oninput: (e) => { settings.solid = +e.target.value; show(); } })),
      el('span', { class: 'soft' }, 'drag: turn · right: move · wheel: nearer')), box);

  let world = null;
  let begun = null;
  let drawn = -1;
  let asked = 0;
  let trialShown = -1;

  async function begin() {
    const renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    renderer.setPixelRatio(window.devicePixelRatio || 1);
    box.replaceChildren(renderer.domElement);
    const scene = new Scene();
    scene.background = new Color(getComputedStyle(document.documentElement).getPropertyValue('--screen').trim());
    scene.add(new AmbientLight(0xffffff, 1.1));
    const camera = new PerspectiveCamera(35, 1, 1, 20000);
    const lamp = new DirectionalLight(0xffffff, 2.2);
    camera.add(lamp);
    lamp.position.set(0.4, 0.6, 1);
    scene.add(camera);
    const controls = new OrbitControls(camera, renderer.domElement);
    const render = () => renderer.render(scene, camera);
    controls.addEventListener('change', render);
    world = { renderer, scene, camera, controls, render, meshes: await models(), trial: null };
    new ResizeObserver(() => {
      const { clientWidth: w, clientHeight: h } = box;
      if (!w || !h) return;
      renderer.setSize(w, h);
      camera.aspect = w / h;
      camera.updateProjectionMatrix();
      render();
    }).observe(box);
  }

  /** Bodies, sources and detectors of a trial. */
  function stage() {
    trialShown = state.trial;
    const t = study.trials[state.trial];
    slider.max = t.frames.length - 1;
    if (world.trial) world.scene.remove(world.trial.group);
    const group = new Group();
    const centres = t.rows.flatMap((row, place) => row.poses.map((pose) => pose && placed(pose, study.bodies[t.bodies[place]].centroid ?? [0, 0, 0]).at)).filter(Boolean);
    const centre = scale(centres.reduce(add, [0, 0, 0]), 1 / Math.max(1, centres.length));
    const bodies = t.bodies.map((body, place) => {
      const mesh = world.meshes.get(body);
      if (!mesh) return null;
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(new Float32Array(mesh.xyz), 3));
      geometry.setIndex(new BufferAttribute(mesh.triangles, 1));
      geometry.computeVertexNormals();
      const node = new Mesh(geometry, new MeshStandardMaterial({ color: t.colours[place], roughness: 0.6, metalness: 0.05, side: DoubleSide }));
      group.add(node);
      return node;
    });
    const views = t.views.map((number) => fluoroscope(study.views[number], centre, centres, group));
    looks.replaceChildren(...study.trials[state.trial].views.map((number, slot) => el('button', { type: 'button', onclick: () => from(slot) }, `from ${study.views[number].name}`)), el('button', { type: 'button', onclick: () => from(-1) }, 'overview'));
    world.scene.add(group);
    world.trial = { group, bodies, views, centre };
    from(-1);
  }

  /** Looks as a fluoroscope does, or at everything. */
  function from(slot) {
    const { camera, controls, trial } = world;
    const up = scale(trial.views[0].down, -1);
    const target = trial.centre;
    let at;
    if (slot >= 0) {
      at = trial.views[slot].view.source;
      camera.up.set(...scale(trial.views[slot].down, -1));
      const reach = norm(sub(at, target));
      camera.fov = Math.min(60, 2 * Math.atan(trial.views[slot].half / trial.views[slot].depth) * 180 / Math.PI);
      camera.position.set(...add(target, scale(unit(sub(at, target)), reach)));
    } else {
      const towards = trial.views.map(({ view }) => unit(sub(view.source, target))).reduce(add, [0, 0, 0]);
      const size = Math.max(...trial.views.map(({ view, corners }) => Math.max(norm(sub(view.source, target)), ...corners.map((c) => norm(sub(c, target))))));
      camera.up.set(...up);
      camera.fov = 35;
      const side = trial.views.length > 1 ? towards : add(towards, trial.views[0].right);
      camera.position.set(...add(target, scale(unit(add(unit(side), scale(up, 0.55))), 1.95 * size)));
    }
    controls.target.set(...target);
    camera.near = 1;
    camera.far = 50000;
    camera.updateProjectionMatrix();
    controls.update();
    world.render();
  }

  async function show() {
    player.textContent = state.playing ? 'pause' : 'play';
    if (!visible()) return;
    const ticket = ++asked;
    try {
      await (begun ??= begin());
      if (ticket !== asked) return;
      if (trialShown !== state.trial) stage();
      const { trial, frame } = state;
      const t = study.trials[trial];
      slider.value = frame;
      label.textContent = `${t.name} · ${t.frames[frame]}`;
      const found = settings.pictures ? await frameOf(trial, frame).catch(() => null) : null;
      if (ticket !== asked) return;
      world.trial.bodies.forEach((node, place) => {
        if (!node) return;
        const pose = t.rows[place].poses[frame];
        node.visible = !!pose;
        if (!pose) return;
        const { q, at } = placed(pose, world.meshes.get(t.bodies[place]).centroid);
        node.position.set(...at);
        node.quaternion.set(q[1], q[2], q[3], q[0]);
        const failed = verdictOf(trial, place, frame) === 'f';
        Object.assign(node.material, { opacity: settings.solid / 100, transparent: settings.solid < 100, wireframe: failed });
      });
      world.trial.views.forEach((view, slot) => {
        const shown = found?.views.find((v) => v.slot === slot);
        view.plane.visible = settings.pictures && !!shown;
        if (shown) {
          view.texture.image = shown.image;
          view.texture.needsUpdate = true;
        }
        view.rays.visible = settings.rays;
      });
      world.render();
      drawn = frame;
      if (frame + 1 < t.frames.length) frameOf(trial, frame + 1).catch(() => {});
    } catch (error) {
      if (!world) begun = null;
      box.replaceChildren(el('p', { class: 'note' }, `The 3D view cannot be shown: ${error.message}`));
    }
  }
  onChange(show);
  return { show, drawn: () => drawn, world: () => world };
}

/** Source, detector and rays of a view. The detector stands where the calibration says, or behind the bodies where that is not known. */
function fluoroscope(view, centre, centres, group) {
  const deepest = Math.max(...[...centres, centre].map((c) => project(view, c)[2]));
  const depth = view.detector_mm ?? 1.35 * deepest;
  const [w, h] = view.size;
  const at = (x, y) => unproject(view, [x, y], depth);
  const corners = [at(-0.5, -0.5), at(w - 0.5, -0.5), at(w - 0.5, h - 0.5), at(-0.5, h - 0.5)];
  const source = new Mesh(new SphereGeometry(0.012 * depth, 20, 12), new MeshStandardMaterial({ color: RAYS, emissive: RAYS, emissiveIntensity: 0.5 }));
  source.position.set(...view.source);
  const lines = (points, colour) => new LineSegments(new BufferGeometry().setFromPoints(points.map((p) => new Vector3(...p))), new LineBasicMaterial({ color: colour }));
  const rays = new Group();
  rays.add(lines(corners.flatMap((c) => [view.source, c]), '#6d6a4a'), lines([view.source, at((w - 1) / 2, (h - 1) / 2)], RAYS));
  group.add(source, rays, new Line(new BufferGeometry().setFromPoints([...corners, corners[0]].map((p) => new Vector3(...p))), new LineBasicMaterial({ color: '#8d97a5' })));
  // The picture lies on the detector without its distortion: places are ideal pixels, the picture's are recorded ones.
  const cells = view.recorded ? 24 : 1;
  const [positions, uvs, index] = [[], [], []];
  for (let j = 0; j <= cells; j++) {
    for (let i = 0; i <= cells; i++) {
      const [x, y] = [i / cells * w - 0.5, j / cells * h - 0.5];
      positions.push(...at(x, y));
      const [u, v] = recorded(view, x, y);
      uvs.push((u + 0.5) / w, 1 - (v + 0.5) / h);
      if (i < cells && j < cells) {
        const k = j * (cells + 1) + i;
        index.push(k, k + 1, k + cells + 1, k + 1, k + cells + 2, k + cells + 1);
      }
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute('uv', new BufferAttribute(new Float32Array(uvs), 2));
  geometry.setIndex(index);
  const texture = new Texture();
  texture.colorSpace = SRGBColorSpace;
  const plane = new Mesh(geometry, new MeshBasicMaterial({ map: texture, side: DoubleSide }));
  plane.visible = false;
  group.add(plane);
  const middle = unproject(view, [w / 2, h / 2], depth);
  return {
    view, corners, plane, texture, rays, depth,
    half: norm(sub(at(w / 2, 0), middle)),
    down: unit(times(view.inverse, [0, 1, 0])), right: unit(times(view.inverse, [1, 0, 0])),
  };
}
