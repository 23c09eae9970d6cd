"""All words of a data sheet, in every language that it is written in."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

#: codes of languages (ISO 639-1), in the order of the columns of `MESSAGES`
LANGUAGES = ("en", "de")
if TYPE_CHECKING:
    LanguageChoice = str
else:
    LanguageChoice = StrEnum("LanguageChoice", [(code, code) for code in LANGUAGES])

#: message of every language by key
MESSAGES: dict[str, tuple[str, str]] = {
    # the language itself
    "decimal mark": (".", ","),
    "date": ("%Y-%m-%d", "%d.%m.%Y"),
    "and": ("and", "und"),
    "range": ("{low} to {high}", "{low} bis {high}"),
    # heading
    "sheet": ("Data sheet", "Datenblatt"),
    "file": ("file", "Datei"),
    "day": ("date", "Datum"),
    "program": ("made by", "erstellt mit"),
    "report": ("Full report", "Vollständiger Bericht"),
    "behind": (
        "All numbers, models and cautions: solidgear compare {file}",
        "Alle Zahlen, Modelle und Hinweise: solidgear compare {file}",
    ),
    # sections
    "section numbers": ("Numbers asked for", "Gefragte Werte"),
    "section bearings": ("Bearings", "Lager"),
    "section worst": ("Worst place", "Höchstbeanspruchte Stelle"),
    "section motions": ("Deflection", "Verformung"),
    "section frequencies": ("Natural frequencies", "Eigenfrequenzen"),
    "section speeds": ("Speeds to avoid", "Zu meidende Drehzahlen"),
    "section assumed": ("Assumed", "Annahmen"),
    "section cautions": ("Cautions", "Hinweise"),
    "section verdict": ("Verdict", "Urteil"),
    # tiles
    "tile fatigue": ("Safety against fatigue", "Sicherheit gegen Dauerbruch"),
    "tile corner": ("not rated: corner at {places}", "ohne Nachweis: Kante bei {places}"),
    "tile corners": (
        "not rated: {count} sharp corners",
        "ohne Nachweis: {count} scharfe Kanten",
    ),
    "tile stress": ("Largest notch stress", "Größte Kerbspannung"),
    "tile nominal": ("Largest nominal stress", "Größte Nennspannung"),
    "tile life": ("Shortest bearing life", "Kürzeste Lagerlebensdauer"),
    "tile motion": ("Largest deflection at a gear", "Größte Verformung am Rad"),
    "tile frequency": ("First natural frequency", "Erste Eigenfrequenz"),
    "tile trust": ("Own error of the model", "Eigener Fehler des Modells"),
    # heads of columns
    "quantity": ("quantity", "Größe"),
    "value": ("value", "Wert"),
    "model error": ("model error", "Modellfehler"),
    "open data": ("open data", "offene Daten"),
    "bearing": ("bearing", "Lager"),
    "type": ("type", "Typ"),
    "radial": ("radial", "radial"),
    "axial": ("axial", "axial"),
    "life": ("life", "Lebensdauer"),
    "life range": ("range", "Spanne"),
    "static": ("S0", "S0"),
    "place": ("place", "Stelle"),
    "across": ("across", "quer"),
    "along": ("along", "längs"),
    "tilt": ("tilt", "Neigung"),
    "mode": ("mode", "Eigenform"),
    "critical": ("order 1 at", "1. Ordnung bei"),
    "order": ("order", "Ordnung"),
    "avoid": ("avoid", "meiden"),
    "hours": ("h", "h"),
    "millions": ("million rev.", "Mio. Umdr."),
    # notes below tables
    "note numbers": (
        "Model error: of mesh and solver. Open data: change over what the file leaves open.",
        "Modellfehler: von Netz und Löser. Offene Daten: Änderung über die Spannen der Eingaben.",
    ),
    "note at point": ("At the lumped point {point}.", "Am Bezugspunkt {point}."),
    "note modified": (
        "Life: modified reference life by ISO/TS 16281 and ISO 281.",
        "Lebensdauer: modifizierte Referenz-Lebensdauer nach ISO/TS 16281 und ISO 281.",
    ),
    "note reference": (
        "Life: basic reference life by ISO/TS 16281, 90 % reliability.",
        "Lebensdauer: nominelle Referenz-Lebensdauer nach ISO/TS 16281, 90 % Zuverlässigkeit.",
    ),
    "note table": (
        "Lives over the duty table, loads at the operating point.",
        "Lebensdauern über das Lastkollektiv, Lasten im Betriebspunkt.",
    ),
    "note no life": (
        "No lives: no bearing has catalogue data.",
        "Keine Lebensdauern: kein Lager hat Katalogdaten.",
    ),
    "note static": ("S0: static safety.", "S0: statische Sicherheit."),
    "note range": (
        "Range: by estimated insides, clearance classes and cleanliness.",
        "Spanne: durch geschätzte Innenmaße, Luftklassen und Sauberkeit.",
    ),
    "note motions": (
        "Size of the motion across the shaft, along it, and of the tilt of its axis, from the unloaded state.",
        "Betrag der Verschiebung quer zur Welle, längs und der Neigung der Achse gegen den unbelasteten Zustand.",
    ),
    "note spin": (
        "Without gyroscopic effects.",
        "Ohne Kreiselwirkung.",
    ),
    "note no mesh bars": (
        "What the meshes leave is not known: {model} shafts have no error bars in modes of a train.",
        "Der Fehler der Netze ist nicht bekannt: {model} hat im Getriebe keine Fehlerangabe.",
    ),
    # verdict
    "trust": ("Trust the {model}.", "Maßgebend ist: {model}."),
    "trust nothing": (
        "No error bar could be shown for the {model}.",
        "Für {model} ließ sich keine Fehlerschranke zeigen.",
    ),
    "trust static": (
        "Its own error is {static} at most; {tolerance} was asked.",
        "Die eigene Fehlerschranke beträgt {static}; gefordert sind {tolerance}.",
    ),
    "trust frequency": (
        "Its own error is {frequency} at most in natural frequencies; {tolerance} was asked.",
        "Die eigene Fehlerschranke der Eigenfrequenzen beträgt {frequency}; gefordert sind {tolerance}.",
    ),
    "trust both": (
        "Its own error is {static} at most, in natural frequencies {frequency}; {tolerance} was "
        "asked.",
        "Die eigenen Fehlerschranken betragen {static}, bei Eigenfrequenzen {frequency}; gefordert "
        "sind {tolerance}.",
    ),
    "cheapest": (
        "The {model} is enough for {within} ({off} off).",
        "Für {within} genügt: {model} ({off} Abweichung).",
    ),
    "none cheaper": (
        "No cheaper model was shown to be enough for {within}.",
        "Für {within} genügt nachweislich kein einfacheres Modell.",
    ),
    "within motion": ("the motion under load", "die Verschiebung unter Last"),
    "within misalignment": ("the misalignment of the gears", "die Schiefstellung der Räder"),
    # worst place
    "worst notch": (
        "{place} at y = {y}: stress amplitude {amplitude} ± {bar} by bending.",
        "{place} bei y = {y}: Spannungsausschlag {amplitude} ± {bar} durch Biegung.",
    ),
    "worst nominal": (
        "{place} at y = {y}: nominal stress amplitude {amplitude} by bending.",
        "{place} bei y = {y}: Nennspannungsausschlag {amplitude} durch Biegung.",
    ),
    "worst least": (
        "With K_1 of the group of steels that falls most: {fatigue} and {yielding}.",
        "Mit K_1 der ungünstigsten Stahlgruppe: {fatigue} und {yielding}.",
    ),
    "worst open": (
        "Open data of the bearings leave {low} to {high}.",
        "Offene Daten der Lager lassen {low} bis {high} zu.",
    ),
    "worst rated": (
        "Safety by DIN 743: {fatigue} against fatigue, {yielding} against yielding.",
        "Sicherheit nach DIN 743: {fatigue} gegen Dauerbruch, {yielding} gegen Fließen.",
    ),
    "worst yielding": (
        "Against yielding {place} at y = {y} has less: {safety}.",
        "Gegen Fließen hat {place} bei y = {y} weniger: {safety}.",
    ),
    "worst crack": (
        "Against a first crack {place} at y = {y} has less: {safety}.",
        "Gegen Anriss hat {place} bei y = {y} weniger: {safety}.",
    ),
    "worst corner": (
        "Not rated: the sharp corner at y = {places}, where the safety may be less; give it a fillet.",
        "Ohne Nachweis: die scharfe Kante bei y = {places}, deren Sicherheit geringer sein kann; mit einer "
        "Rundung wird sie bewertet.",
    ),
    "worst corners": (
        "Not rated: {count} sharp corners at y = {places}, where the safety may be less; give them "
        "fillets.",
        "Ohne Nachweis: {count} scharfe Kanten bei y = {places}, deren Sicherheit geringer sein kann; mit "
        "Rundungen werden sie bewertet.",
    ),
    "worst section": (
        "Largest nominal stress: {equivalent} (von Mises) in segment {segment} at y = {y}; bending "
        "{bending}, torsion {torsion}.",
        "Größte Nennspannung: {equivalent} (von Mises) im Abschnitt {segment} bei y = {y}; Biegung {bending}, "
        "Torsion {torsion}.",
    ),
    "of shaft": ("{place}, shaft {shaft}", "{place}, Welle {shaft}"),
    # speeds
    "turns": ("Speed: {speed}.", "Drehzahl: {speed}."),
    "turns of": ("Speed of shaft {shaft}: {speed}.", "Drehzahl der Welle {shaft}: {speed}."),
    "order of shaft": ("order {order} of the shaft", "{order}. Ordnung der Welle"),
    "order of named shaft": (
        "order {order} of shaft {source}",
        "{order}. Ordnung der Welle {source}",
    ),
    "order of mesh": (
        "order {order} of the mesh{source}",
        "{order}. Ordnung des Eingriffs{source}",
    ),
    "speeds far": (
        "No order listed comes within {near} of this speed. The nearest is the {order} with "
        "{mode} at {critical}.",
        "Keine dieser Ordnungen liegt näher als {near} an dieser Drehzahl. Am nächsten: {order} mit "
        "{mode} bei {critical}.",
    ),
    "speeds none": (
        "No order 1 to 3 of a mesh, or 1 to 4 of a shaft, meets a listed mode within {near} of it.",
        "Keine 1. bis 3. Ordnung eines Eingriffs und keine 1. bis 4. einer Welle trifft eine dieser "
        "Eigenformen näher als {near} daran.",
    ),
    # why a section is left out
    "absent load": (
        "Not computed: the file has no load.",
        "Nicht berechnet: die Datei nennt keine Last.",
    ),
    "absent operation": (
        "Not computed: the file has no operating point with a torque.",
        "Nicht berechnet: die Datei nennt keinen Betriebspunkt mit Drehmoment.",
    ),
    "absent speed": (
        "Not computed: no speed is given.",
        "Nicht berechnet: keine Drehzahl angegeben.",
    ),
    "absent train speed": (
        "Not computed: the operating point has no speed.",
        "Nicht berechnet: der Betriebspunkt nennt keine Drehzahl.",
    ),
    "absent bearings": ("There is no bearing.", "Es gibt kein Lager."),
    "absent numbers": (
        "None of the numbers asked for exists here.",
        "Keiner der gefragten Werte existiert hier.",
    ),
    "absent notch": (
        "No notch is rated: there is no fillet, and no other notch of DIN 743.",
        "Keine Kerbe ist bewertet: es gibt keine Rundung und keine andere Kerbe der DIN 743.",
    ),
    "absent strength": (
        "No safety by DIN 743: the material of {names} has no strength in the file.",
        "Keine Sicherheit nach DIN 743: der Werkstoff von {names} hat in der Datei keine Festigkeit.",
    ),
    # assumed
    "assumed inside": (
        "Inside of bearing {names} estimated from size and ratings.",
        "Innenmaße von Lager {names} aus Abmessungen und Tragzahlen geschätzt.",
    ),
    "assumed clearance": (
        "Clearance of bearing {names} in the middle of its class.",
        "Lagerluft von {names} in der Mitte ihrer Klasse.",
    ),
    "assumed stiffness": (
        "Stiffness of bearing {names} neither measured nor published.",
        "Steifigkeit von Lager {names} weder gemessen noch veröffentlicht.",
    ),
    "assumed angle": (
        "Pressure angle of {names} taken as 20 degrees.",
        "Eingriffswinkel von {names} mit 20 Grad angenommen.",
    ),
    "assumed belt": (
        "Both sides of the belt of {names} pull along one direction.",
        "Beide Trums von {names} ziehen in einer Richtung.",
    ),
    "assumed ranges": (
        "Open within a range: {names}.",
        "Offen in einer Spanne: {names}.",
    ),
    "assumed without ranges": (
        "Ranges by open data not worked out; solidgear budget has them.",
        "Spannen durch offene Daten nicht ermittelt; solidgear budget zeigt sie.",
    ),
    "assumed entries": (
        "Neither measured nor published: {names}.",
        "Weder gemessen noch veröffentlicht: {names}.",
    ),
    "assumed factors": (
        "DIN 743 with factors set to 1, as they are not given: {names}.",
        "DIN 743 mit Faktor 1, weil nicht angegeben: {names}.",
    ),
    "assumed unrated": (
        "Not rated by DIN 743: {names}.",
        "Nicht nach DIN 743 bewertet: {names}.",
    ),
    "assumed weight": (
        "Weight acts as well; it is in all numbers, and not drawn.",
        "Auch das Gewicht wirkt; es steckt in allen Zahlen und ist nicht gezeichnet.",
    ),
    "assumed steady": (
        "Axial force and torque are taken as steady, as their amplitudes are not given.",
        "Längskraft und Drehmoment gelten als ruhend, weil ihre Ausschläge nicht angegeben sind.",
    ),
    "assumed no torque": (
        "No torque runs along the shaft in the stress.",
        "In der Spannung läuft kein Drehmoment durch die Welle.",
    ),
    "assumed elastic": (
        "Linear elastic, loads at rest, shaft turning under them.",
        "Linear elastisch, ruhende Lasten, umlaufende Welle.",
    ),
    # cautions
    "caution tolerance": (
        "The error bar reaches {bar} where {tolerance} was asked.",
        "Die Fehlerschranke erreicht {bar}, gefordert sind {tolerance}.",
    ),
    "caution lost": (
        "Bearing {name} carries no load somewhere in the open ranges.",
        "Lager {name} trägt in einem Teil der offenen Spannen keine Last.",
    ),
    "caution static": (
        "Bearing {name}: static safety {safety} is below 1.",
        "Lager {name}: statische Sicherheit {safety} liegt unter 1.",
    ),
    "caution overloaded": (
        "Bearing {name}: equivalent load is {share} of C; ISO 281 holds up to 0.5.",
        "Lager {name}: äquivalente Last ist {share} von C; ISO 281 gilt bis 0,5.",
    ),
    "caution fatigue": (
        "{place}: safety against fatigue {safety} is below the {least} of DIN 743.",
        "{place}: Sicherheit gegen Dauerbruch {safety} liegt unter {least} nach DIN 743.",
    ),
    "caution yielding": (
        "{place}: safety against yielding {safety} is below the {least} of DIN 743.",
        "{place}: Sicherheit gegen Fließen {safety} liegt unter {least} nach DIN 743.",
    ),
    "caution crack": (
        "{place}: safety against a first crack {safety} is below the {least} of DIN 743.",
        "{place}: Sicherheit gegen Anriss {safety} liegt unter {least} nach DIN 743.",
    ),
    "caution spin": (
        "Frequencies are those at rest; at {speed} spin moves {mode} by {down} to {up}.",
        "Frequenzen gelten im Stillstand; bei {speed} verschiebt die Drehung {mode} um {down} bis {up}.",
    ),
    "caution at rest": (
        "Frequencies are those at rest; how far spin moves them is not known.",
        "Frequenzen gelten im Stillstand; wie weit die Drehung sie verschiebt, ist nicht bekannt.",
    ),
    "caution seat": (
        "How a seat holds the shaft decides numbers: see solidgear check.",
        "Wie ein Sitz die Welle hält, bestimmt die Zahlen: siehe solidgear check.",
    ),
    "caution teeth": (
        "The stiffness of the teeth in contact is doubtful: see solidgear contact.",
        "Die Steifigkeit der Zähne im Eingriff ist fraglich: siehe solidgear contact.",
    ),
    "caution speed": (
        "The {order} meets {mode} at {critical}, {off} from the speed.",
        "Nur {off} neben der Drehzahl: {order} trifft bei {critical} auf {mode}.",
    ),
    "elsewhere": (
        "{count} more in the output of solidgear deflect and stress.",
        "{count} weitere in der Ausgabe von solidgear deflect und stress (englisch).",
    ),
    "more": ("And {count} more.", "Und {count} weitere."),
    # operating point
    "under point": ("At {torque} on {shaft}.", "Bei {torque} an {shaft}."),
    "under point at speed": (
        "At {torque} and {speed} on {shaft}.",
        "Bei {torque} und {speed} an {shaft}.",
    ),
    "under named point": (
        "Operating point {name}: {torque} on {shaft}.",
        "Betriebspunkt {name}: {torque} an {shaft}.",
    ),
    "under named point at speed": (
        "Operating point {name}: {torque} and {speed} on {shaft}.",
        "Betriebspunkt {name}: {torque} und {speed} an {shaft}.",
    ),
    "case": ("Load case {name}.", "Lastfall {name}."),
    "case of": (
        "Load case {name}, of {count}; lives are over all of them.",
        "Lastfall {name} von {count}; Lebensdauern über alle.",
    ),
    # models
    "model lumped": ("lumped model", "Punktmassenmodell"),
    "model rigid": ("rigid shaft", "starre Welle"),
    "model euler": ("Euler beam", "Euler-Balken"),
    "model timoshenko": ("Timoshenko beam", "Timoshenko-Balken"),
    "model harmonic": ("harmonic solid", "harmonisches Volumenmodell"),
    "model corrected": ("corrected solid", "korrigiertes Volumenmodell"),
    "model sector": ("cyclic sector", "zyklischer Sektor"),
    "model solid": ("3D solid", "3D-Volumenmodell"),
    "model matrices": ("matrices of the file", "Matrizen der Datei"),
    # quantities
    "quantity C_zz": ("Compliance across", "Nachgiebigkeit quer"),
    "quantity C_xx": ("Compliance across, other plane", "Nachgiebigkeit quer, andere Ebene"),
    "quantity C_yy": ("Compliance along", "Nachgiebigkeit längs"),
    "quantity C_thx": ("Compliance in tilt", "Nachgiebigkeit gegen Kippen"),
    "quantity C_z,thx": ("Coupling across and tilt", "Kopplung quer und Kippen"),
    "quantity K_zz": ("Stiffness across", "Steifigkeit quer"),
    "quantity K_yy": ("Stiffness along", "Steifigkeit längs"),
    "quantity K_thx": ("Stiffness in tilt", "Steifigkeit gegen Kippen"),
    "quantity K_z,thx": ("Coupling stiffness across and tilt", "Koppelsteifigkeit quer und Kippen"),
    "at places": ("at {places}", "an {places}"),
    # measures of misalignment
    "measure E": ("Offset E", "Achsversatz E"),
    "measure P": ("Pinion shift P", "Ritzelverschiebung P"),
    "measure G": ("Gear shift G", "Radverschiebung G"),
    "measure shaft angle": ("Change of shaft angle", "Änderung des Achswinkels"),
    "measure in plane": ("Slope in plane of action", "Schiefstellung in der Eingriffsebene"),
    "measure across": ("Slope across it", "Schiefstellung quer dazu"),
    "measure wind-up": ("Wind-up over the face", "Verdrillung über die Zahnbreite"),
    "measure f_sh": ("Misalignment f_sh", "Flankenlinienabweichung f_sh"),
    "measure KHb": ("Face load factor KHb, ISO 6336-1", "Breitenfaktor KHb, ISO 6336-1"),
    # motions of modes
    "family bending": ("bending", "Biegung"),
    "family axial": ("axial", "Längsschwingung"),
    "family torsion": ("torsion", "Torsion"),
    "family ovalising": ("ovalising", "Ovalisierung"),
    "family rotational": ("rotational", "Drehung"),
    "family along": ("along", "längs"),
    "family about": ("about", "um"),
    "mode train rotation": ("train rotation", "freie Drehung"),
    "mode free motion": ("free motion", "freie Bewegung"),
    # drawing
    "drawing": (
        "To scale, upper half in section; dimensions in {unit}. Orange: loads. Blue: bearings and "
        "their forces on the shaft. ⊙ acts towards the reader (+x), ⊗ away.",
        "Im Maßstab, obere Hälfte geschnitten; Maße in {unit}. Orange: Lasten. Blau: Lager und ihre "
        "Kräfte auf die Welle. ⊙ wirkt zum Betrachter hin (+x), ⊗ von ihm weg.",
    ),
    "drawing alone": (
        "To scale, upper half in section; dimensions in {unit}.",
        "Im Maßstab, obere Hälfte geschnitten; Maße in {unit}.",
    ),
    "radii enlarged": (
        "Radii are drawn {times} times larger than lengths.",
        "Radien sind {times}-fach gegenüber Längen vergrößert.",
    ),
    "shafts left out": ("Not drawn: {names}.", "Nicht gezeichnet: {names}."),
    "bore": ("bore", "Bohrung"),
    "speed": ("speed", "Drehzahl"),
}
