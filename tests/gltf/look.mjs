// What the validator of Khronos and three.js make of glTF files: a line of JSON for each.
//
// { errors, warnings, messages,          what the validator says
//   triangles, materials,                how many there are in the file
//   times: [s],                          of the animation's keys
//   bodies: [{ name,
//     box: [[x, y, z], [x, y, z]],       around the triangles at the first time
//     poses: [[x, y, z, qx, qy, qz, qw]] at each time
//   }] }
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
  const bodies = (nodes[0].children ?? []).map((node) => {
    return { name: nodes[node].name, object: objects.get(node), box: null, poses: [] };
  });
  const [clip] = gltf.animations;
  const times = clip ? Array.from(clip.tracks[0].times) : [0];
  const mixer = new AnimationMixer(gltf.scene);
  if (clip) {
    const action = mixer.clipAction(clip);
    action.setLoop(LoopOnce, 1);
    action.clampWhenFinished = true;
    action.play();
  }
  for (const time of times) {
    mixer.setTime(time);
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
  }
  return { times, bodies: bodies.map(({ name, box, poses }) => ({ name, box, poses })) };
}
