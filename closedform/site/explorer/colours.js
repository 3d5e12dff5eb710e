/** The colours of a picture. */

/** Of the branches, in their order; people who do not see all colours can tell them apart. */
const BRANCHES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a63d2", "#7a7a00"];
/** Of what is singular, out of reach or published wrongly. */
export const WARNING = "#cc3311";

/** The colour of a branch. */
export const branchColour = (k) => BRANCHES[k % BRANCHES.length];

/** A colour of the style sheet: of the paper, of the ink or of the ground. */
export function colourOf(place, name) {
    return getComputedStyle(place).getPropertyValue(`--explorer-${name}`).trim();
}
