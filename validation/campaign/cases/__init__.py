"""The campaigns, by name."""

from validation.campaign.cases.answers import Answers
from validation.campaign.cases.claims import Claims
from validation.campaign.cases.features import Features
from validation.campaign.cases.fillets import Fillets
from validation.campaign.cases.identification import Identification
from validation.campaign.cases.modes import Modes
from validation.campaign.cases.notches import Notches
from validation.campaign.cases.pairing import Pairing
from validation.campaign.cases.pairs import Pairs
from validation.campaign.cases.points import Points
from validation.campaign.cases.shafts import Shafts
from validation.campaign.cases.solids import Solids

DRAWN = (
    Answers(),
    Shafts(),
    Pairs(),
    Points(),
    Features(),
    Claims(),
    Modes(),
    Fillets(),
    Notches(),
    Identification(),
    Pairing(),
    Solids(),
)
CASES = {case.name: case for case in DRAWN}
