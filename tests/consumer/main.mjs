// A page's view of the package: where is the hand, and which angles bring it there?
import { BRANCHES, DEFAULTS, Status, fk, ik, ik_batch } from "closedform/planar_2r";
import { puma560 } from "closedform";

const hand = fk([0.3, -1.1]);
const { q, status } = ik(hand);
console.log(`links ${DEFAULTS.l1} and ${DEFAULTS.l2}, hand ${hand.map((x) => x.toFixed(6)).join(" ")}`);
q.forEach((angles, i) => {
    const found = angles.map((angle) => angle.toFixed(6)).join(" ");
    console.log(`${BRANCHES[i]} status ${status[i]} angles ${found}`);
});

// three targets at once: all x, then all y
const batch = ik_batch(3, Float64Array.of(1, 10, 100, 1, 10, 100));
console.log(`statuses ${batch.status.join(" ")}`);
console.log(`the Puma has ${puma560.ik(puma560.pose([0, 0.1, 0.2, 0.3, 0.4, 0.5])).q.length} branches`);
process.exitCode = status.every((s) => s === Status.OK) ? 0 : 1;
