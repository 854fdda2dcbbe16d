"""Names of what the text of a file states: radius, arm, pitch, load, sample rate."""

from __future__ import annotations

import re

from tribolab.reading.lexicon.lexicon import key_pattern

RATE, INTERVAL = key_pattern("sampling_rate"), key_pattern("sampling_interval")
LOAD = key_pattern("load")
PITCH, PROFILE_LENGTH, POINTS = (
    key_pattern("pitch"),
    key_pattern("profile_length"),
    key_pattern("points"),
)
TRAVERSE_SPEED = key_pattern("traverse_speed")
UNIT, HEIGHT_UNIT, NO_HEIGHT = (
    key_pattern("unit"),
    key_pattern("height_unit"),
    key_pattern("not_height"),
)
VERTICAL, ALONG = key_pattern("vertical"), key_pattern("along")
TIP, ACROSS_TIP = key_pattern("tip_radius"), key_pattern("tip_diameter")
OF_TRACE, PART_OF_TRACE = key_pattern("length_of_trace"), key_pattern("part_of_trace")
RADIUS, OTHER_RADIUS = key_pattern("track_radius"), key_pattern("other_radius")
ARM, AT_ARM = key_pattern("arm"), key_pattern("force_at_arm")
SHAFT, TURNING, OUTER = key_pattern("shaft"), key_pattern("turning"), key_pattern("outer")
DIAMETER, ACROSS, ON_TRACK = (
    key_pattern("track_diameter"),
    key_pattern("diameter"),
    key_pattern("on_track"),
)
ZERO = key_pattern("zero")
STROKE, HALF_STROKE, FREQUENCY = (
    key_pattern("stroke"),
    key_pattern("half_stroke"),
    key_pattern("frequency"),
)
PER_MINUTE = re.compile(
    r"rpm|1/min|min-1|(?:rev|r|U|tr|ot|obr|giri|d|dev|devir)\.?/\s?(?:min|dk|dak)", re.IGNORECASE
)

# rigs whose counter-body slides on the outside of what turns: the track is as wide as that
ON_RIM = re.compile(
    r"(?:block|pin|ball|cylinder|pad|klotz|stift|kugel|bloc|patin|bloque|pattino|kloc|blok)s?[\s_/-]*"
    r"(?:on|against|vs|auf|gegen|sur|sobre|contra|su|na|op|mot|pa)[\s_/-]*(?:the[\s_-]*)?"
    r"(?:rings?|rims?|rollers?|wheels?|shafts?|ringe?|rolle|welle|rad|anneau|galet|anillo|rodillo|anello|rullo|hjul)"
    r"|(?:block|klotz|kloc(?:ek|ka)?|bloc|bloque|blocco|bloco|blok|pattino|patin|sapata|tuk)s?[\s_/–-]{1,3}"
    r"(?:ring|halka|gy[űu]r[űu]|rengas|pier[śs]cie[ńn]|anneau|anillo|anello|anel|krou[žz]e?k|rolk|rolle|welle|galet|rullo|rodillo|rulle)"
    r"|(?:pier[śs]cie[ńn]|rolk\w|krou[žz]ek|anneau|anillo|anello|anel|welle|rolle)[\s_/–-]{1,3}"
    r"(?:klotz|kloc|bloc|bloque|blok)"
    r"|ring[\s_-]?block|ブロックオンリング|环块|環塊|블록온링|timken|lfw"
    # seals and bearings slide on the shaft
    r"|(?:lip|shaft|rotary|rotating)[\s_-]*seals?|wellendicht|\brwdr\b|simmerring"
    r"|joint\w* (?:à|a) l[eè]vre|joint\w* (?:rotatif|tournant)|paraolio|retentor|ret[eé]n(?:es)? de"
    r"|油封|旋转密封|オイルシール|오일씰"
    r"|ролик\w*[\s–-]+(?:колодк|частичн)\w*|колодк\w*[\s–-]+(?:по[\s-]+)?(?:ролик|вал|кольц)\w*|вал\w*[\s–-]+(?:втулк|колодк|вкладыш)\w*"
    r"|(?:roller|wheel|shaft|rolle|welle|galet|rullo)[\s/–-]+(?:shoe|block|pad|segment|backe|klotz|sabot|patin|ceppo)"
    r"|glidlager|glideleje|glidelager|glijlager|liukulaaker|подшипник\w* скольжения|сальник|манжет"
    r"|journal bearing|plain bearing|gleitlager|radiallager|palier lisse|滑动轴承|すべり軸受"
    r"|cojinete|cuscinett\w+ (?:liscio|radente)|mancal|łożysk\w* ślizg|kluzn\w* lo[zž]isk"
    r"|g[uü]feron?\b|hř[ií]delov",
    re.IGNORECASE,
)

NOT_TAKEN_OFF = re.compile(
    r"\bnot?\s(?:been\s)?(?:yet\s)?(?:zero|offset|tare|drift)?[\s-]?(?:correct|compens|subtract|adjust|remov)"
    r"|(?:zero|offset|tare)\s(?:is\s|was\s)?not\s|\bnot\s(?:tared|zeroed)|un(?:corrected|tared|zeroed)"
    r"|\bnot?\s(?:been\s)?(?:yet\s)?(?:deduct|taken\soff)|\bstill\s(?:in|contained|included)\b"
    r"|\b(?:to|must|should)\sbe\s(?:subtract|deduct|taken\soff|remov)|\bsubtract\b|abzuziehen|abziehen"
    r"|\b(?:soustraire|déduire|sottrarre|detrarre|restar|descontar|subtrair|aftrekken|retrancher)\b"
    r"|ode[cč]íst|odjąć|вычесть|відняти|[需要应应]扣除|差し引く"
    r"|nicht\s\w{0,20}(?:korrigiert|bereinigt|abgezogen|kompensiert|tariert)|unkorrigiert|noch\senthalten"
    r"|non\s(?:corrig|compens|azzer|soustra|sottra|tar|dédui|detratt)"
    r"|no\s(?:corregid|compensad|restad|descontad)|sin\s(?:corregir|restar|descontar)"
    r"|não\s(?:corrig|compens|subtra|descont)"
    r"|(?:ej|inte|ikke)\s(?:korriger|kompenser|subtra|avdrag|trukk|fratruk)"
    r"|niet\s(?:gecorrigeerd|gecompenseerd|afgetrokken)|nie\s(?:odj|skoryg|skompens)|neode[cč]ten"
    r"|не\s(?:скоррект|вычт|учт)|未(?:校正|修正|扣除|減算|補正)|未補正",
    re.IGNORECASE,
)
# behind the zero itself, where no other sentence is needed to say of what
OFF_ALREADY = re.compile(
    r"subtracted|deducted|removed|corrected|compensated|taken\soff|abgezogen|korrigiert|kompensiert"
    r"|soustrait|dédui|corrigé|sottratt|detratt|corrett|restad|descontad|corregid|corrigid|subtraíd"
    r"|afgetrokken|gecorrigeerd|odję|skoryg|odečten|korriger|扣除|校正|補正|減算",
    re.IGNORECASE,
)
TAKEN_OFF = re.compile(
    r"(?:zero|offset|tare)[\s-](?:is\s|was\s)?(?:correct|compens|subtract|remov|adjust)"
    r"|(?<!not )(?:tared|zeroed)\b|nullpunktkorrigiert|nullpunktbereinigt|tariert|compensado"
    r"|corregido|corretto|corrigé|已(?:校正|扣除)|補正済",
    re.IGNORECASE,
)


def is_radius(name: str) -> bool:
    """Whether a column's name, squeezed, is that of the radius of a track.

    >>> is_radius("trackradius"), is_radius("radiomediodelapista"), is_radius("ballradius")
    (True, True, False)
    """
    return bool(RADIUS.search(name) and not OTHER_RADIUS.search(name))
