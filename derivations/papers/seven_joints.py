"""Arms of seven joints, whose inverse needs one input besides the pose."""

from closedform.derivations.papers.textbooks import (
    HE_LIU,
    KREUTZ_DELGADO_LONG_SERAJI,
    LOPEZ_CUSTODIO_GONG_FIGUEREDO,
    SHIMIZU_AND_OTHERS,
)

from closedform import Paper

ARM_ANGLE = Paper(
    "arm-angle",
    "Arms of seven joints by their arm angle, solved by lemmas",
    ("The closedform authors",),
    works=(KREUTZ_DELGADO_LONG_SERAJI, SHIMIZU_AND_OTHERS),
)
OFFSET_ARMS = Paper(
    "offset-arms",
    "Arms of seven joints with offsets, solved by lemmas",
    ("The closedform authors",),
    works=(HE_LIU, LOPEZ_CUSTODIO_GONG_FIGUEREDO),
)
