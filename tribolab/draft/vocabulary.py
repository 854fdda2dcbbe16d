"""The one vocabulary of column names in many languages, from which quantities are proposed."""

from __future__ import annotations

from typing import NamedTuple


class Word(NamedTuple):
    """A quantity and how columns that hold it are called.

    Symbols are whole names; stems may stand anywhere in a name. Both are written as
    `tribolab.draft.words.words.squeezed` leaves them; of two symbols for one quantity the first
    is the better. A vague stem is one that other quantities are called by, too: it is always a
    guess.
    """

    quantity: str
    symbols: tuple[str, ...]
    stems: tuple[str, ...]
    vague: tuple[str, ...] = ()


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split())


RUN_WORDS = (
    Word(
        "time",
        _words("t time zeit ts xvalue dt deltat δt interval intervall cas tid"),
        _words(
            "steptime testtime elapsedtime timestamp time zeit elapsed dauer uhr seconds sekunden "
            "temps duree tiempo tempo durata clock tijd runtime laufzeit stopwatch "
            "czas zaman время 시간 时间 時間 经过时间 経過時間 時刻"
        ),
    ),
    Word(
        "friction_force",
        _words(
            "fx ff fr ft fric frict freib ffric ffr fq ftan ftang lf flat ffriction ftr fтр froz "
            "fs fh fy fat"
        ),
        _words(
            "frictionforce frictionalforce fricforce tangentialforce tangforce lateralforce "
            "horizontalforce horizontalload latforce "
            "tractionforce shearforce dragforce drag lateral tangential wrijvingskracht wrijving "
            "reibkraft reibungskraft tangentialkraft querkraft friction traction reibung "
            "forcex xforce sledforce pullforce pullingforce zugkraft "
            "forcedefrottement efforttangentiel forcetangentielle frottement "
            "fuerzadefriccion fuerzaderozamiento fuerzatangencial friccion rozamiento "
            "fuerzafriccion fuerzarozamiento forcefrottement forzaattrito forcaatrito "
            "forzadiattrito forzadattrito forzatangenziale attrito "
            "forcadeatrito forcatangencial atrito silatarcia tarcie trecisila friktionskraft "
            "kitkavoima surlodasiero suertuenmekuvveti suertuenme "
            "силатрения тангенциальнаясила 마찰력 접선력 摩擦力 切向力 剪切力 せん断力 接線力 摩擦 "
            "抵抗力 摩阻力 阻力 "
            "tangenziale tangenzial tangentielle tangentiel tangencial styczna тангенциальн "
            "касательн"
        ),
        _words(
            "standardkraft pruefkraft "
            "force kraft loadcell kraftmessdose kraftaufnehmer effort fuerza forza forca kuvvet "
            "сила 力 测力"
        ),
    ),
    Word(
        "normal_force",
        _words("fn fz fnorm fnormal w l nf fv normal normale normalna p n"),
        _words(
            "normalforce normalload normload normforce axialforce axialload forzaassiale "
            "caricoassiale forceaxiale effortaxial fuerzaaxial cargaaxial forcaaxial osovasila "
            "silaosiowa осеваясила силаосевая 轴向力 軸方向力 축하중 "
            "verticalforce verticalload "
            "balload ballload "
            "pressingforce pressforce clampingforce downforce appliedforce "
            "normaalkracht aandrukkracht belasting "
            "appliedload contactforce normalkraft axialkraft anpresskraft auflast normallast "
            "load last belastung forcez zforce forcenormale effortnormal chargenormale charge "
            "fuerzanormal carganormal carga forzanormale cariconormale carico "
            "forcanormal silanacisku silanormalna nacisk obciazenie normalovasila pritlacnasila "
            "zatizeni normaalivoima normalero nyomoero normalkuvvet normalyuek yuek "
            "нормальнаясила нагрузка 수직하중 수직력 하중 "
            "试验力 试验载荷 試験荷重 "
            "法向力 正压力 法向载荷 载荷 載荷 负荷 负载 加载力 垂直荷重 法線力 垂直力 荷重"
        ),
        _words("loadcell"),
    ),
    Word(
        "friction_coefficient",
        _words("mu cof my mue ffn fxfz cf"),
        _words(
            "frictioncoefficient frictioncoeff frictionfactor "
            "coefficientoffriction coeffoffriction coffriction "
            "coefffriction tractioncoefficient tractioncoeff reibwert reibungszahl reibzahl "
            "reibungskoeffizient reibkoeffizient friction cof reibung "
            "coefficientdefrottement coeffdefrottement coeffrottement frottement "
            "coeficientedefriccion coeficientederozamiento friccion rozamiento "
            "coefficientediattrito coefficientedattrito coeffdiattrito coeffdattrito attrito "
            "coeficientedeatrito coefdeatrito wspolczynniktarcia koeficienttreni souciniteltreni "
            "souctreni koeftreni wspoltarcia wsptarcia коэфтрения kitkakerr "
            "friktionskoefficient kitkakerroin suertuenmekatsayisi коэффициенттрения 마찰계수 "
            "摩擦系数 摩擦係數 摩擦因数 摩擦係数 摩擦"
        ),
    ),
    Word(
        "sliding_velocity",
        _words("v vx vel us hiz"),
        _words(
            "slidingspeed slidingvelocity slipspeed linearspeed linearvelocity "
            "gleitgeschwindigkeit velocity geschwindigkeit speed "
            "vitessedeglissement vitesselineaire vitesse velocidaddedeslizamiento velocidadlineal "
            "velocidad velocitadiscorrimento velocitadistrisciamento velocitalineare velocita "
            "predkoscslizgania predkosc rychlost glidhastighet hastighet nopeus sebesseg "
            "kaymahizi hizi скоростьскольжения скорость 미끄럼속도 속도 "
            "滑动速度 滑動速度 线速度 すべり速度 滑り速度 摺動速度 速度"
        ),
    ),
    Word(
        "position",
        _words("x s pos xpos enc disp stage"),
        _words(
            "horizontaldisplacement horizontalposition "
            "strokeposition strokepos position displacement displ extension crosshead stroke "
            "slidingdistance "
            "distance verschiebung auslenkung gleitweg traversenweg standardweg strecke weg hub "
            "travel encoder "
            "deplacement course posicion desplazamiento recorrido posizione spostamento corsa "
            "posicao deslocamento przemieszczenie polozenie poloha posunuti foerskjutning "
            "yerdegistirme konum перемещение положение 변위 위치 "
            "位移 位置 行程 滑动距离 変位 ストローク 摺動距離"
        ),
        _words("lvdt"),
    ),
    Word(
        "set_speed",
        _words("vset vsoll"),
        _words(
            "setspeed setvelocity targetspeed speedset sollgeschwindigkeit geschwindigkeitsoll "
            "vitessedeconsigne 设定速度 設定速度"
        ),
    ),
    Word(
        "set_normal_force",
        _words("fset fsoll fzset fnset"),
        _words(
            "setload setforce setnormalforce targetload targetforce sollkraft solllast "
            "chargedeconsigne 设定载荷 設定荷重"
        ),
    ),
    Word(
        "rolling_speed", (), _words("rollingspeed entrainmentspeed entrainment rollgeschwindigkeit")
    ),
    Word("slide_roll_ratio", ("srr",), _words("slideroll slidetoroll schlupf")),
    Word(
        "rotation_speed",
        _words("rpm n omega"),
        _words(
            "rotation drehzahl rotary spindle spindel toerental "
            "angularspeed angularvelocity rotationalspeed "
            "vitessederotation velocidaddegiro velocidadderotacion giri velocitadirotazione "
            "velocidadederotacao rotacao predkoscobrotowa obroty otacky varvtal devir "
            "частотавращения обороты 회전수 회전속도 转速 轉速 回転数 回転速度"
        ),
        _words(
            "speed velocity geschwindigkeit vitesse velocidad velocita predkosc rychlost hastighet "
            "hizi скорость 속도 速度"
        ),
    ),
    Word(
        "normal_stress",
        ("sigman",),
        _words("normalstress normalspannung contactpressure pressung contraintenormale 法向应力"),
    ),
    Word(
        "shear_stress",
        ("tau",),
        _words("shearstress frictionstress schubspannung stress cisaillement 剪切应力 せん断応力"),
    ),
    Word("shear_rate", (), _words("shearrate scherrate schergefaelle 剪切速率 せん断速度")),
    Word("viscosity", ("eta",), _words("viscosity viskositaet viscosite viscosita 粘度 黏度")),
    Word(
        "temperature",
        _words("t temp theta"),
        _words(
            "lubetemp lubertdtemp contacttemp temperature temperatur temp temperatura teplota "
            "sicaklik температура 온도 温度 溫度"
        ),
    ),
    Word(
        "ambient_pressure",
        ("p",),
        _words("ambientpressure airpressure luftdruck pressure druck pression presion pressione")
        + _words("气压 圧力 压力"),
    ),
    Word("film_thickness", (), _words("filmthickness averagefilm schmierfilm filmdicke film 膜厚")),
    Word(
        "height_displacement",
        ("z",),
        _words(
            "verticaldisplacement verticalposition axialdisplacement axialposition "
            "weardepth wearheight verschleisstiefe profondeurusure linearwear "
            "height wear verschleiss depth hoehe usure desgaste usura penetration eindringtiefe "
            "磨损 磨損 摩耗"
        ),
        _words("lvdt"),
    ),
    Word(
        "electrical_contact_resistance",
        ("ecr",),
        _words(
            "contactresistance uebergangswiderstand resistancedecontact "
            "contactpotential filmpercent "
            "film 接触电阻 接触抵抗"
        ),
    ),
    Word(
        "contact_resistance",
        ("rc",),
        _words(
            "contactresistance uebergangswiderstand kontaktwiderstand resistancedecontact "
            "resistenciadecontacto resistenzadicontatto ecr 接触电阻 接触抵抗"
        ),
    ),
    Word("voltage", ("u",), _words("voltage spannung tension tensione voltaje 电压 電圧")),
    Word(
        "step",
        _words(
            "step schritt segment stage etape paso passo block phase stap 步骤 "
            "specimen specimenno specimennumber pull pullno prober probekoerper probennr pruefling "
            "probekoerpernr eprouvette eprouvetteno noeprouvette probeta probetano nprobeta "
            "provino nprovino corpodeprova cuerpodeprueba probka nrprobki vzorek образец "
            "номеробразца "
            "试样 试样号 试样编号 試験片 試験片番号 시편 시편번호"
        ),
        _words("stepno stepnumber"),
    ),
    Word(
        "cycle",
        _words("cycle zyklus lap laps revolution cycles ciclo tour tours vuelta giro n循环"),
        _words("cycleno cyclenumber cyclecount zykluszahl 循环 循環 サイクル 圈数 回数"),
    ),
)

# weights for forces: what they mean depends on the quantity
WEIGHTS = {"g": "gf", "kg": "kgf", "lb": "lbf", "lbs": "lbf", "oz": "ozf"}

SCAN_WORDS = (
    Word(
        "x",
        ("x",),
        _words(
            "lateral abscis abszis ascissa "
            "position distance messweg weg strecke laenge length abstand longueur "
            "distancia distanza posicion posizione posicao longitud lunghezza recorrido "
            "laege posisjon sijainti matka poloha vzdalenost drah polozenie pozycj odleglosc "
            "dlugosc konum mesafe uzunluk tavolsag hosszusag положение расстояние длина координата "
            "位置 距离 距離 长度 위치 거리"
        ),
    ),
    Word("y", ("y",), ()),
    Word(
        "height",
        _words("z h"),
        _words(
            "height hoehe profile profil totalprofile rawprofile amplitude topography depth tiefe "
            "raw hauteur altura perfil profilo profondeur profundidad profondita ordonnee ordenada "
            "elevation relief ordinate hoogte "
            "altezza altezze quota quote cota cotas ordinata altitud "
            "vyska wysokosc hojd hoyde hojde hoejd hoeyde hoejde yuekseklik yukseklik "
            "ордината ординаты korkeus magassag visina высота 높이 高度 高さ"
        ),
    ),
)

# by which a file's encoding is told: a single sign may stand in any wrong reading of other letters
EASTERN_WORDS = frozenset(
    stem
    for word in (*RUN_WORDS, *SCAN_WORDS)
    for stem in (*word.stems, *word.vague)
    if len(stem) > 1 and not stem.isascii()
)
