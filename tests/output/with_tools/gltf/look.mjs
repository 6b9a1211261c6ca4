// Loads glTF files with the Khronos validator and three.js, and prints a line of JSON for each file:
//
// { errors, warnings, messages,          the validator's results
//   triangles, materials,                their numbers in the file
//   times: [s],                          the times of the animation's keys, s
//   bodies: [{ name,
//     box: [[x, y, z], [x, y, z]],       the bounding box of the triangles at the first time
//     poses: [[x, y, z, qx, qy, qz, qw]] location and orientation at each time
//     sizes: [s]                         the scale at each time, and just before each time but the first; 0 hides the body
//   }],
//   cameras: [{ name, near, far,
//     spots: [[[x, y]]]                  the first five bodies in the picture at each time; the picture's edges are at -1 and 1
//   }],
//   lights: [{ name, type, color: [r, g, b], intensity,
//     places: [[x, y, z]], toward: [x, y, z] }] }  location at each time; direction at the first time, for parallel light
import { readFile } from 'node:fs/promises';
import validator from 'gltf-validator';
import { AnimationMixer, Box3, LoopOnce, Quaternion, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

for (const path of process.argv.slice(2)) {
  const bytes = await readFile(path);
  const report = await validator.validateBytes(new Uint8Array(bytes), { maxIssues: 100 });
  const { issues, info } = report;
  const found = { errors: issues.numErrors, warnings: issues.numWarnings, messages: issues.messages };
  Object.assign(found, { triangles: info.totalTriangleCount, materials: info.materialCount });
  Object.assign(found, await poses(bytes));
  console.log(JSON.stringify(found));
}

async function poses(bytes) {
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
  const gltf = await new GLTFLoader().parseAsync(buffer, '');
  const { nodes } = gltf.parser.json;
  const objects = new Map();
  gltf.scene.traverse((object) => {
    const known = gltf.parser.associations.get(object);
    if (known?.nodes !== undefined && !objects.has(known.nodes)) objects.set(known.nodes, object);
  });
  const bodies = [];
  const cameras = [];
  const lights = [];
  for (const node of nodes[0].children ?? []) {
    const { name } = nodes[node];
    const object = objects.get(node);
    if (object.isCamera) {
      cameras.push({ name, object, near: object.near, far: object.far, spots: [] });
    } else if (object.isLight) {
      const { type, intensity } = object;
      lights.push({ name, type, object, color: object.color.toArray(), intensity, places: [], toward: null });
    } else {
      bodies.push({ name, object, box: null, poses: [], sizes: [] });
    }
  }
  const [clip] = gltf.animations;
  const times = clip ? Array.from(clip.tracks[0].times) : [0];
  const mixer = new AnimationMixer(gltf.scene);
  if (clip) {
    const action = mixer.clipAction(clip);
    action.setLoop(LoopOnce, 1);
    action.clampWhenFinished = true;
    action.play();
  }
  for (const [i, time] of times.entries()) {
    if (i) {
      mixer.setTime(time - 0.1 * (time - times[i - 1]));
      bodies.forEach(({ object, sizes }) => sizes.push(object.scale.x));
    }
    mixer.setTime(time);
    bodies.forEach(({ object, sizes }) => sizes.push(object.scale.x));
    gltf.scene.updateMatrixWorld(true);
    for (const body of bodies) {
      const place = body.object.getWorldPosition(new Vector3());
      const turn = body.object.getWorldQuaternion(new Quaternion());
      body.poses.push([...place.toArray(), ...turn.toArray()]);
      if (!body.box) {
        const { min, max } = new Box3().setFromObject(body.object, true);
        body.box = [min.toArray(), max.toArray()];
      }
    }
    for (const camera of cameras) {
      const seen = bodies.slice(0, 5).map((body) => new Vector3(...body.poses.at(-1).slice(0, 3)));
      camera.spots.push(seen.map((place) => place.project(camera.object).toArray().slice(0, 2)));
    }
    for (const light of lights) {
      const place = light.object.getWorldPosition(new Vector3());
      light.places.push(place.toArray());
      if (light.object.isDirectionalLight) {
        light.toward ??= light.object.target.getWorldPosition(new Vector3()).sub(place).toArray();
      }
    }
  }
  const plain = ({ object, ...rest }) => rest;
  return { times, bodies: bodies.map(plain), cameras: cameras.map(plain), lights: lights.map(plain) };
}
