"""Words for what the text of a file states: radius, arm, pitch, load, sample rate."""

from __future__ import annotations

import re

from tribolab.draft.words.words import or_term

# a sample rate by its name; "Frequency" alone may be that of the strokes
_TAKEN = (
    r"(?:sampl|abtast|acqui|adquis|aquisi|scan|log|data|daten|daq|mess|meet|record|captur|update"
    r"|aufzeich|aufnahme|echantillon|muestre|campion|amostrag|bemonster|probkow|vzork|mintavetel"
    r"|выбор|дискрет|опрос|采集|采样|取样|収録)"
)
_OFTEN = (
    r"(?:rate|rata|freq|frek|frecuen|cadenc|taux|tasa|taxa|vitess|veloc|geschwind|hastighet"
    r"|частот|czestotl|częstotl|率|周波数|レート|速度)"
)
RATE = or_term(
    rf"^(?:rate|fs|daqrate)$|{_TAKEN}.*{_OFTEN}|{_OFTEN}.*{_TAKEN}"
    r"|abtastrate|cadence|echantillonnage|muestreo|campionamento|采样|サンプリング"
    r"|^(?:sampling|acquisition|logging|abtastung|aufzeichnung|sampled|logged|recorded|acquired|abgetastet|aufgezeichnet)$",
    "sampling_rate",
)
# what passes from one sample to the next
INTERVAL = re.compile(
    r"^(?:dt|deltat|timestep|timeinterval|zeitschritt|tsample|ts)$"
    r"|^(?:sampl|scan|log|mess|abtast|record|acquisition|data|zeit)\w*"
    r"(?:interval|period|time|intervall|periode|schritt|spacing)$"
    r"|pasdetemps|pasodetiempo|passotemporale|passodetempo|tijdstap|tidssteg|periododemuestreo"
    r"|intervallodicampionamento|perioded?echantillonnage|采样间隔|采样周期|サンプリング(?:間隔|周期)"
)
LOAD = or_term(
    r"^(?:normal|applied|dead|sled|schlitten|test|axial|static|set)?"
    r"(?:load(?:ed|set)?|force|weight|mass|gewicht|masse|kraft|last)+$"
    r"|^(?:normalkraft|auflast|normallast|belastet|belastung|chargenormale|charge|forcenormale"
    r"|effortnormal|carganormal|carga|fuerzanormal|cariconormale|carico|caricato|forzanormale|peso|poids"
    r"|nacisk|obciazenie|zatizeni|zatez|nagruzka|нагрузка|нормальнаясила|belasting|kuorma|terheles|yuek"
    r"|(?:nacisk|obciazenie|zatizeni|нагрузка|carico|carga|charge|load|last)(?:fn|fz|f|p|w|n)"
    r"|试验力|法向力|法向载荷|载荷|负载|荷重|垂直荷重|試験荷重|載荷|(?:추|수직|시험|직접)?하중|추무게|おもり(?:荷重|質量)?|錘|砝码(?:质量|重量)?)$"
    r"|^(?:carga|pesos?|mas+[ae]|poids|carico|charge|fuerza|forza|forca|effort)(?:normale?)?"
    r"(?:do|da|de|del|della|des|du|aplicada|appliquee|applicato)\w{0,12}$"
    r"|^(?:total|gesamt|mean|mittlere)?(?:lip|lippen|seal|ring)?radial(?:force|load|kraft|last)"
    r"(?:total|gesamt)?$|径向力$"
    r"|^(?:carico|forza|charge|force|effort|carga|fuerza|forca|obciazenie|nacisk|sila)"
    r"(?:normal[ea]?|radial[ea]?|axial[ea]?|assiale|vertical[ea]?|tota[a-z]{1,3}|complessiv[ao]|globale?)+"
    r"(?:(?:do|da|de|del|della|des|du|sul|sur|sobre|en|na|on)\w{0,16})?$"
    r"|^(?:dead|tot|eigen)(?:weight|gewicht|load|last)\w{0,20}$"
    r"|^(?:poids|peso)m(?:ort|uert)o?\w{0,20}$"
    r"|^(?:normal)?(?:load|force|weight)(?:on|per|onto|upon)(?!cell)\w{0,12}$"
    r"|^(?:forceradiale|effortradial|fuerzaradial|forzaradiale|caricoradiale)\w{0,12}$",
    "load",
)
# the distance of a profile's points by its name
PITCH = or_term(
    r"^(?:d?x|deltax|pitch|spacing|increment|step|stepsize|stepping|interval|xscale)$"
    r"|^(?:schritt\w*|x?pas|x?paso|x?passo|x?stap\w*|x?schritt\w*|sampling|sampled|abtastung)$|(?:abtast|mess)schritt"
    r"|^(?:шаг|pikselboyutu|ornekleme|oernekleme|askel|naytevali|naeytevaeli)\w*|间隔|간격"
    r"|^(?:roztec|rozestup|krok|odstep|avstand|steglangd|lepeskoz)\w*"
    r"|^шаг\w*|间距|步长|步距|ピッチ|間隔|点间隔|采样间隔"
    r"|(?:sampl|point|mess|punkt|data|x|lateral|measur|echantillon|abtast|punt)\w*"
    r"(?:pitch|spacing|increment|step|interval|distance|abstand|afstand|schritt\w*|intervall)"
    r"|(?:distan[czt]\w*?|afstand|abstand|ecart|espaciado|intervall?[eo]?|pas|paso|passo)"
    r"(?:de\w?|di|entre(?:les|los)?|tra\w?|fra\w?|tussen|zwischen\w{0,5}|der)?"
    r"(?:punt\w+|points?|pontos?|punkten?|muestreo|d?echantillonnage|campionamento|amostragem)$"
    r"|(?:pitch|spacing|increment|interval)(?:x|between\w*)?$",
    "pitch",
)
# the length of a whole profile, over which its points lie: no cut-off, no length of a part
PROFILE_LENGTH = or_term(
    r"^(?:total|full|x|line)?(?:scan|trace|tracing|taster?|meet|travers\w*|profile?|evaluation|assessment|record"
    r"|measur\w+|mess|tast(?:er?)?|abtast|gesamt|lateral|data)?(?:ed|ing)?"
    r"(?:length|laenge|strecke|range|weg|lengte)(?:x|lt|ln)?$"
    r"|^(?:longueur|longitud|lunghezza|comprimento)"
    r"(?:de|del|di|du|dela|della|da|d)?(?:mesure|mesuree|palpage|palpee|exploration|profil\w*|balayage"
    r"|evaluee?|evaluation"
    r"|medida|medicion|recorrido|exploracion|evaluacion|trazado|barrido|misura\w*|esplorazione"
    r"|scansione|traccia|valutazione|medicao|varredura|avaliacao|perfil)?$"
    r"|^(?:длина|dlugosc|delka|hossz|pituus|uzunluk)(?:трассы|профиля|измерения|pomiaru|profilu|odcinka|mereni)?$"
    r"|^(?:测量|扫描|轮廓|取样)?长度$|^(?:測定|走査)?長さ$",
    "profile_length",
)
# how fast a stylus goes over a profile
_GOES = (
    r"(?:tast|abtast|travers\w*|scan\w*|measur\w*|mess|meet|probe|stylus|tracing|vorschub|feed|palpage"
    r"|mesure|exploration|avance|varredura|medi\w+|barrido|scansione|misura|esplorazione|deplacement"
    r"|mat|sond|sensor|pomiar\w*|przesuw\w*|skan\w+|posuv\w*|mereni|snimani|перемещ\w+|движ\w+|скан\w+"
    r"|ощуп\w+|трассир\w+|измер\w+|olcum|oelcuem|tarama|扫描|测量|移动|进给|測定|送り|走査|측정|이송)"
)
_FAST = (
    r"(?:speed|velocity|snelheid|geschwindigkeit|vitesse|velocidade?|velocita|rate|hastighe[td]"
    r"|nopeus|predkosc|rychlost|sebesseg|hizi?|скорость|速度|속도)"
)
TRAVERSE_SPEED = re.compile(rf"{_GOES}.{{0,4}}{_FAST}|{_FAST}.{{0,4}}{_GOES}")
# how many points a profile has
POINTS = or_term(
    r"^(?:number|numbers|no|nr|n|num|total|count)?(?:of|de)?(?:data|measured?|measuring|profile)?"
    r"(?:points?|pts?|samples?|values?|heights?|pixels?)(?:number|count|total)?$"
    r"|^(?:anzahl|zahl|aantal|antal|antall)(?:der)?(?:mess|daten|profil)?(?:punkte|punten|punkter|waarden|werte|hoehen)$"
    r"|^(?:mess|daten|profil)?punkt(?:e|anzahl|zahl|eanzahl)$|^(?:count|npts|npoints|nx|anzahl)$"
    r"|^(?:nombre|nb|numero|num|no|n)(?:de|dei|di|des|dos)?"
    r"(?:points?|puntos?|punti|pontos?|mesures|valores|valori|echantillons|muestras)$"
    r"|^(?:количество|число|liczba|ilosc|pocet)(?:точек|punktow|probek|bodu)$"
    r"|^(?:点数|采样点数|数据点数|データ点数|測定点数)$",
    "points",
)
UNIT = re.compile(
    r"^(?:unit|units|einheit|einheiten|unite|unites|unidad|unidades|unita|unidade|eenheid"
    r"|eenheden|enhet|enheter|enhed|enheder|yksikko|yksikot|jednostka|jednostki|jednotka|jednotky"
    r"|mertekegyseg|birim|birimler|единицы?|单位|単位)$"
)
HEIGHT_UNIT = re.compile(
    r"^(?:z|height|hoehe?n?|profile?|amplitude|hauteur|altura|altezza|quota|cota|hoogte|ordinate|data|value)s?"
    r"(?:axis|achse|values?|werte?|data)?(?:unit|units|einheit|unite|unidad|unita|unidade|eenheid|in)$"
    r"|^(?:unit|units|einheit|unite|unidad|unita|unidade|eenheid)(?:of|der|de|des|dela|di|delle|das?)?"
    r"(?:the)?(?:z|heights?|hoehen?|hauteurs?|alturas?|altezz[ae]|quot[ae]|cotas?|hoogtes?|ordinat[ae]|ordinates"
    r"|profile?|profilo|amplitude)$"
    r"|^高度单位$|^高さ単位$"
)
# across the surface, and sizes of the instrument: what is in such a unit is no height
NO_HEIGHT = re.compile(
    r"^[dxy]?[xy](?:axis|achse|units?|einheit)?$|^(?:unit|units|einheit)(?:of|der|de)?[xy]$"
    r"|lateral|horizont|abs[cz]iss|position|distan[czt]|abstand|afstand|weg$|strecke|spacing|pitch|step|pas|paso|passo"
    r"|sampl|abtast|length|laenge|lengte|longueur|longitud|lunghezza|comprimento|wid(?:th|e)|breite"
    r"|largeur|anch[oi]|tip|stylus|spitz|taster|probe|radius|diamet|durchmesser|cutoff|cut|filter"
    r"|wavelength|lambda|wellenlaenge|range|scanner|location|file|version"
    r"|横|纵|长度|長さ|位置|距离|間隔|间距|步长|半径"
)
VERTICAL = re.compile(
    r"vert[iy][ck]?al|^z(?:axis|achse|scale|data|values?)?$|senkrecht|ordinat|ordonnee|ordenad"
    r"|vertikaal|pionow|pystysuor|lodret|lodrett|svisl|垂直|縦"
)
ALONG = re.compile(
    r"^x(?:axis|achse|values?)?(?:units?|einheit)?$|^(?:unit|units|einheit)(?:of|der|de)?x$|lateral"
    r"|horizontal|abs[cz]iss"
)
_RADIUS_WORDS = (
    r"(?:radius|rayon|radio|raggio|raio|straal|polomer|promien|saede|sade|radie|yaricap|sugar"
    r"|радиус|半径)"
)
_TIP_WORDS = (
    r"(?:tip|uc(?=yaricap)|stylus|styli|needle|spitz|taster|tastnadel|nadel|punta|puntal|palpa|palpe|tastator|pointe|puntina|agulha|ponta|naald"
    r"|hrot|ostrz|kaerje|karje|nal|игл|щуп|针|針|触针|探针)"
)
TIP = re.compile(
    rf"{_TIP_WORDS}.*(?:{_RADIUS_WORDS}|dia|durchm|直径)"
    rf"|(?:{_RADIUS_WORDS}|dia\w*|durchm\w*|直径).*{_TIP_WORDS}|^rtip$|^r?(?:tip|stylus)r$"
)
ACROSS_TIP = re.compile("dia|durchm|直径")
# a length that is surely the trace's: "length" may be that of the part, "range" that of the gauge
OF_TRACE = re.compile(
    r"(?:scan|trac|travers|profile?|measur|mess|tast|total|full|gesamt|data|record|line|meet)\w*"
    r"(?:length|laenge|strecke|weg|lengte)"
    r"|(?:longueur|longitud|lunghezza|comprimento).+|(?:测量|扫描|轮廓|測定|走査)"
)
# a part of the trace, over which an instrument computes
PART_OF_TRACE = re.compile(r"evalu|assess|ln$|valutazione|avaliacao|auswert|sampling|einzel")
RADIUS = or_term(
    "promien|polomer|радиус|yaricap|saede$|sugar[a]?$|radie$|radius|rayon|radio(?!met)|raggio|raio|straal|半径",
    "track_radius",
)
ARM = re.compile(
    r"lever(?!ratio)|hebelarm|arm(?:length|laenge|lengde|laengd)|torquearm|momentarm|kraftarm|^arm$|levier|brasde"
    r"|^(?:yuekhuecresi)?kol(?:uzunlugu)?|momentkolu"
    r"|palanca|brazo|braccio|vipuvarsi|ramie|rameno|плечо|力臂|杠杆臂|アーム|腕の長さ"
)
# a force that acts on an arm, by its name
AT_ARM = re.compile(
    r"^kolkuvveti$|^kolyuku$|^(?:moment|torque|lever|hebel|tork)?arm(?:force|kraft|load)?$|arm(?:force|kraft|kracht|load)$|hebelkraft|leverforce|(?:force|load)(?:on|at|of)?(?:the)?(?:arm|lever)$"
    r"|kraft(?:am|an)?(?:hebel|arm)(?:arm)?$|(?:force|effort)(?:au|sur|du)?(?:le)?(?:bras|levier)|fuerza(?:en|del|de)?(?:el|la)?(?:brazo|palanca)"
    r"|forza(?:al|sul|del)?(?:la)?(?:braccio|leva)|сила(?:на)?(?:плече|рычаге)|силанарычаге|臂力|力臂力|アーム力|アーム荷重"
)
SHAFT = re.compile(
    r"shaft|journal|welle(?!n?laenge)|zapfen|arbre|tourillon|albero|perno|^eje|arbol|eixo|hridel|aksel|^axel|^axl|walek|czop|^as(?:diameter)|вал|шейк|轴|軸|축"
)
OTHER_RADIUS = re.compile(
    "ball|tip|sphere|kugel|probe|pin|stylus|cylinder|bille|bola|sfera|球|针|探|curvature|fillet|nose"
)
_TRACK = "track|wear|spur|laufbahn|reib|friction|path|piste|traccia|pista|sliding|gleit|磨|轨|摩擦"
# of the track, not of a ball or a disc
DIAMETER = or_term(
    rf"(?:{_TRACK}).*(?:dia|durchmesser|直径)|(?:dia(?:m\w*)?|durchmesser).*(?:{_TRACK})",
    "track_diameter",
)
ACROSS = or_term(
    r"dia|durchmesser|diametr|диаметр|srednica|prumer|halkaisija|atmero|^cap[i]?$|capi$|直径|外径|内径|轴径|軸径|내경|외경|축경|^(?:ø|oe|⌀)$|^d$|od$",
    "track_diameter",
)
ON_TRACK = or_term(_TRACK, "track_radius")
PER_MINUTE = re.compile(
    r"rpm|1/min|min-1|(?:rev|r|U|tr|ot|obr|giri|d|dev|devir)\.?/\s?(?:min|dk|dak)", re.IGNORECASE
)
# what turns may be wider than the track on it
TURNING = re.compile(
    r"dis[ck]|scheibe|ring|plate|platte|disque|disco|anneau|anello|anillo|pierscien|specimen|sample|盘|環|环|円板|リング|ディスク|디스크"
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
OUTER = re.compile(
    r"ring|halka|gyuru|rengas|pierscien|krouz|rolk|anel|rim|roll|wheel|shaft|outer|outside|aussen|exter|anneau|anello|anillo|galet|hjul|welle"
    r"|ролик|кольц|вал|arbre|albero|eje|arbol|eixo|hridel|aksel|axel|wal|リング|环|環|外|轴|軸|축|od$"
)

# what the sensor shows without friction, and whether it is still in the signal
ZERO = re.compile(
    r"zero|offset|(?:torque|moment|couple|coppia|koppel)\w{0,6}(?:noload|unloaded|idle|leerlauf|avide|avuoto|envacio|emvazio|zonderlast)"
    r"|(?:noload|unloaded|idle|idling|bearing|spindle|leerlauf|lager|parasitic|drag)\w{0,6}(?:torque|moment)|nullpunkt|nulllage|nullwert|nullsignal|^null|tara|tare|nollpunkt|nollage|nulpunt"
    r"|nulstil|nolla|cero|零点|零位|ゼロ|ноль|нуль|영점|sifir|nula|nulov"
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
