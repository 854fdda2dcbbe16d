"""What laboratories call things, as they write it: whole terms, a line for each language.

Columns of a table have the first ten, the text above it states the others. Stems and patterns of
`tribolab.draft.vocabulary` and `tribolab.draft.words.stated_words` know further names; a term
that stands here is no guess.
"""

from __future__ import annotations

# fmt: off
_LINES = {
    "friction_force": """
        Friction force | Tangential force | Lateral force | Frictional force | Traction force
        | Shear force | Drag force | Horizontal force | F friction | Pull force | Pulling force
        Fuerza de tracción | Força de tração | Force de traction | Forza di trazione | Zugkraft
        Forza di tiro | Forza tiro | Forza di traino | Forza traino | Fuerza de tiro | Fuerza tiro
        Traktionskraft | Trakční síla | Siła trakcji | Сила тяги | Тяговое усилие | Trekkraft
        Trækkraft | Dragkraft | Trekkracht | Vetovoima | Vonóerő | Çekme kuvveti | 牵引力 | 견인력
        摩擦力 | 切向力 | 摩擦阻力
        Třecí síla | Tečná síla
        Friktionskraft | Tangentialkraft
        Wrijvingskracht | Tangentiële kracht | Wrijving
        Kitkavoima | Tangentiaalivoima
        Force de frottement | Force tangentielle | Effort tangentiel | Effort de frottement
        Reibkraft | Reibungskraft | Tangentialkraft | Gleitreibungskraft
        Súrlódási erő | Súrlódóerő | Tangenciális erő
        Forza di attrito | Forza d'attrito | Forza tangenziale
        摩擦力 | せん断力 | 接線力 | 水平力
        마찰력 | 접선력
        Friksjonskraft | Tangentialkraft
        Siła tarcia | Siła styczna
        Força de atrito | Força tangencial | Força de fricção
        Forța de frecare | Forta de frecare | Forța tangențială
        Сила трения | Тангенциальная сила | Касательная сила
        Trecia sila | Tangenciálna sila
        Fuerza de fricción | Fuerza de rozamiento | Fuerza tangencial | Fuerza de roce
        Friktionskraft | Tangentialkraft | Tangentiell kraft
        Sürtünme kuvveti | Teğetsel kuvvet
        Сила тертя | Дотична сила
    """,
    "normal_force": """
        Normal force | Normal load | Load | Applied load | Contact force | Axial load
        | Vertical force | Down force
        法向力 | 正压力 | 载荷 | 法向载荷 | 垂直载荷
        Normálová síla | Zatížení | Přítlačná síla
        Normalkraft | Belastning
        Normaalkracht | Aandrukkracht | Belasting
        Normaalivoima | Kuormitus | Kuorma
        Force normale | Charge normale | Effort normal | Charge appliquée
        Normalkraft | Anpresskraft | Auflast | Prüflast
        Normál erő | Nyomóerő | Terhelés
        Forza normale | Carico normale | Carico applicato | Carico
        垂直荷重 | 荷重 | 法線力 | 押付力 | 垂直力
        수직하중 | 수직력 | 하중 | 법선력
        Normalkraft | Belastning
        Siła normalna | Obciążenie | Nacisk | Siła nacisku
        Força normal | Carga normal | Carga aplicada | Carga
        Forța normală | Sarcina | Sarcina normală
        Нормальная сила | Нагрузка | Нормальная нагрузка | Сила прижима
        Normálová sila | Zaťaženie | Prítlačná sila
        Fuerza normal | Carga normal | Carga aplicada | Carga
        Normalkraft | Anläggningskraft | Normallast
        Normal kuvvet | Normal yük | Yük
        Нормальна сила | Навантаження | Нормальне навантаження
    """,
    "friction_coefficient": """
        Friction coefficient | COF | Coefficient of friction | Coeff. of friction
        | Traction coefficient | CoF
        摩擦系数 | 摩擦因数 | 摩擦係數
        Koeficient tření | Součinitel tření
        Friktionskoefficient
        Wrijvingscoëfficiënt | Wrijvingscoefficient
        Kitkakerroin
        Coefficient de frottement | Coeff. de frottement | Coef. frottement
        Reibungszahl | Reibwert | Reibungskoeffizient | Gleitreibungszahl
        Súrlódási tényező | Súrlódási együttható
        Coefficiente di attrito | Coefficiente d'attrito | Coeff. attrito
        摩擦係数 | 動摩擦係数
        마찰계수
        Friksjonskoeffisient
        Współczynnik tarcia | Wsp. tarcia
        Coeficiente de atrito | Coef. de atrito | Coeficiente de fricção
        Coeficient de frecare | Coeficientul de frecare
        Коэффициент трения | Коэф. трения | К-т трения
        Koeficient trenia | Súčiniteľ trenia
        Coeficiente de fricción | Coeficiente de rozamiento | Coef. de fricción
        Friktionskoefficient | Friktionstal
        Sürtünme katsayısı
        Коефіцієнт тертя
    """,
    "sliding_velocity": """
        Sliding speed | Velocity | Linear speed | Sliding velocity | Surface speed | Belt speed
        | Track speed
        滑动速度 | 线速度 | 速度 | 滑動速度
        Rychlost | Kluzná rychlost | Rychlost skluzu
        Glidehastighed | Hastighed
        Glijsnelheid | Snelheid | Schuifsnelheid
        Liukunopeus | Nopeus
        Vitesse de glissement | Vitesse | Vitesse linéaire
        Gleitgeschwindigkeit | Geschwindigkeit | Relativgeschwindigkeit
        Csúszási sebesség | Sebesség
        Velocità di strisciamento | Velocità | Velocità di scorrimento | Velocità lineare
        すべり速度 | 速度 | 摺動速度 | 移動速度
        미끄럼 속도 | 속도 | 슬라이딩 속도
        Glidehastighet | Hastighet
        Prędkość poślizgu | Prędkość | Prędkość ślizgania
        Velocidade de deslizamento | Velocidade | Velocidade linear
        Viteza de alunecare | Viteza | Viteză
        Скорость скольжения | Скорость | Линейная скорость
        Rýchlosť | Klzná rýchlosť
        Velocidad de deslizamiento | Velocidad | Velocidad lineal
        Glidhastighet | Hastighet
        Kayma hızı | Hız
        Швидкість ковзання | Швидкість
    """,
    "rotation_speed": """
        Rotational speed | RPM | Spindle speed | Disc speed | Rotation speed | Rotary speed
        转速 | 轉速 | 旋转速度
        Otáčky | Rychlost otáčení
        Omdrejningstal | Omdrejninger pr. minut
        Toerental | Omwentelingen per minuut | Rotatiesnelheid
        Pyörimisnopeus | Kierrosnopeus | Kierrosluku | Pyör.nopeus | Pyör. nop.
        Vitesse de rotation | Tours par minute | Régime
        Drehzahl | Umdrehungen pro Minute
        Fordulatszám
        Velocità di rotazione | Giri al minuto | Numero di giri
        回転数 | 回転速度
        회전수 | 회전속도
        Turtall | Omdreininger per minutt | Rotasjonshastighet
        Prędkość obrotowa | Obroty
        Velocidade de rotação | Rotação | Rotações por minuto
        Turația | Turatie | Viteza de rotație
        Частота вращения | Обороты | Скорость вращения
        Otáčky
        Velocidad de giro | Velocidad de rotación | Revoluciones por minuto
        Varvtal | Rotationshastighet | Varv per minut
        Devir | Dönme hızı | Devir sayısı
        Частота обертання | Оберти
    """,
    "torque": """
        Torque | Friction torque | Frictional torque | Moment
        摩擦力矩 | 扭矩 | 摩擦扭矩 | 力矩
        Třecí moment | Krouticí moment | Moment tření
        Friktionsmoment | Drejningsmoment | Moment
        Wrijvingsmoment | Koppel | Draaimoment
        Kitkamomentti | Vääntömomentti | Momentti
        Couple de frottement | Couple | Couple résistant
        Reibmoment | Drehmoment | Reibungsmoment | Moment
        Súrlódási nyomaték | Nyomaték
        Coppia di attrito | Coppia | Momento di attrito | Coppia d'attrito
        摩擦トルク | トルク
        마찰 토크 | 토크
        Friksjonsmoment | Dreiemoment
        Moment tarcia | Moment obrotowy | Moment
        Torque de atrito | Torque | Binário de atrito | Momento de atrito
        Moment de frecare | Cuplu
        Момент трения | Крутящий момент | Момент
        Trecí moment | Krútiaci moment
        Par de fricción | Par | Momento de fricción | Par de rozamiento
        Friktionsmoment | Vridmoment | Moment
        Sürtünme momenti | Tork | Moment
        Момент тертя | Крутний момент
    """,
    "position": """
        Position | Displacement | Lateral displacement | Lateral disp. | Stage position
        | Carriage position | Stroke position | Sliding distance | Travel | Stage pos
        | Probe position | Sample position | Slider position | Table position | Linear stage
        | Stage displacement | Slide position | Encoder position | Drive position | Sled position
        | Drive displacement | Sled displacement | Crosshead position | Crosshead displacement
        | Poloha pohonu | Poloha vozíku | Dráha pohonu | Aandrijfpositie | Positie slede
        | Positie aandrijving | Drivposition | Slädens position | Drivenhetens position
        | Antriebsposition | Antriebsweg | Schlittenweg | Traversenweg | Position Antrieb
        | Position du chariot | Position de l'entraînement | Déplacement du chariot
        | Déplacement de la traverse | Posizione carro | Posizione slitta | Posizione azionamento
        | Posizione della slitta | Posizione della traversa | Spostamento slitta
        | Posición del carro | Posición del accionamiento | Desplazamiento del carro
        | Desplazamiento de la mordaza | Posição do carro | Posição do acionamento
        | Położenie napędu | Położenie wózka | Położenie sań | Przemieszczenie wózka
        | Положение привода | Положение каретки | 驱动位置 | 滑台位置 | 駆動位置 | ステージ位置
        位移 | 位置 | 行程
        Poloha | Posunutí | Dráha
        Position | Forskydning | Vandring
        Positie | Verplaatsing | Afgelegde weg
        Asema | Sijainti | Siirtymä | Paikka
        Position | Déplacement | Course
        Weg | Position | Schlittenposition | Auslenkung
        Pozíció | Elmozdulás | Út
        Posizione | Spostamento | Corsa
        位置 | 変位 | ストローク | 移動距離
        위치 | 변위
        Posisjon | Forskyvning
        Położenie | Przemieszczenie | Pozycja
        Posição | Deslocamento | Curso
        Poziție | Deplasare
        Перемещение | Положение | Координата
        Poloha | Posunutie | Dráha
        Posición | Desplazamiento | Recorrido
        Position | Läge | Förskjutning | Förflyttning
        Konum | Yer değiştirme
        Переміщення | Положення
    """,
    "time": """
        Time | Elapsed time | Test time | Timestamp
        时间 | 時間 | 试验时间 | 测试时间
        Čas | Doba
        Tid
        Tijd | Verstreken tijd | Duur
        Aika | Kulunut aika
        Temps | Durée | Temps écoulé
        Zeit | Prüfzeit | Versuchszeit | Messzeit
        Idő
        Tempo | Durata | Tempo trascorso
        時間 | 経過時間 | 時刻 | 試験時間
        시간 | 경과시간
        Tid
        Czas | Czas testu
        Tempo | Duração | Tempo decorrido
        Timp | Durata
        Время | Время испытания
        Čas
        Tiempo | Tiempo transcurrido | Duración
        Tid | Provtid
        Zaman | Süre
        Час
    """,
    "temperature": """
        Temperature | Oil temperature | Specimen temp | Bath temperature
        温度 | 试样温度 | 油温
        Teplota | Teplota oleje
        Temperatur | Olietemperatur
        Temperatuur | Olietemperatuur
        Lämpötila | Öljyn lämpötila
        Température | Température d'huile
        Temperatur | Öltemperatur | Probentemperatur
        Hőmérséklet | Olajhőmérséklet
        Temperatura | Temperatura olio
        温度 | 試料温度 | 油温
        온도 | 시편 온도
        Temperatur | Oljetemperatur
        Temperatura | Temperatura oleju
        Temperatura | Temperatura do óleo
        Temperatura
        Температура | Температура масла
        Teplota
        Temperatura | Temperatura del aceite
        Temperatur | Oljetemperatur
        Sıcaklık | Yağ sıcaklığı
        Температура
    """,
    "height": """
        Height | Raw profile | Profile height | Z | Depth
        高度 | 轮廓高度 | 高度值
        Výška | Profil
        Højde | Profil
        Hoogte | Profielhoogte | Profiel
        Korkeus | Profiili
        Hauteur | Altitude | Profil brut
        Höhe | Profilhöhe | Rohprofil
        Magasság | Profil
        Altezza | Profilo | Quota
        高さ | 断面曲線 | 表面高さ
        높이 | 표면 높이
        Høyde | Profil
        Wysokość | Profil
        Altura | Perfil | Altura do perfil
        Înălțime | Profil
        Высота | Профиль
        Výška
        Altura | Perfil | Altura del perfil
        Höjd | Profilhöjd | Profil
        Yükseklik | Profil
        Висота
    """,
    "load": """
        Load | Normal load | Applied load | Dead weight | Normal force | Test load | Constant load
        载荷 | 法向载荷 | 试验力 | 正压力 | 试验载荷 | 加载力
        Zatížení | Normálová síla | Zátěž
        Belastning | Normalkraft | Last
        Belasting | Normaalkracht | Normale belasting | Last
        Kuorma | Normaalivoima | Normaalikuorma | Kuormitus | Asetusvoima | Asetuskuorma
        Charge normale | Charge | Force normale | Charge appliquée | Effort normal
        Normalkraft | Prüflast | Belastung | Last | Prüfkraft
        Terhelés | Normál terhelés | Normál erő
        Carico | Carico normale | Carico applicato | Forza normale
        荷重 | 垂直荷重 | 試験荷重 | 設定荷重
        하중 | 수직하중 | 시험 하중
        Last | Belastning | Normallast
        Obciążenie | Nacisk | Siła normalna | Obciążenie normalne
        Carga | Carga normal | Carga aplicada | Força normal
        Sarcina | Sarcina normală | Forța normală | Încărcare
        Нагрузка | Нормальная нагрузка | Нормальная сила
        Zaťaženie | Normálová sila
        Carga | Carga normal | Carga aplicada | Fuerza normal | Peso aplicado
        Normallast | Last | Normalkraft | Belastning
        Yük | Normal yük | Uygulanan yük
        Навантаження | Нормальне навантаження
        Slædens masse | Slædens vægt | Slædevægt | Sledens masse | Sledens vekt | Sledevekt
        Slädens massa | Slädens vikt | Slädvikt | Kelkan massa | Kelkan paino | Massa slede
        슬레드 하중 | 슬레드 무게 | 슬레드 질량 | 滑块质量 | 滑橇质量 | スレッド荷重 | そり質量
        Радиальное усилие | Радиальное усилие манжеты | Радиальное усилие манжеты на вал
        Радиальная нагрузка | Сила прижима | Усилие прижима | Осевая нагрузка | Осевая сила
        Нагрузка на образец | Масса груза | Масса салазок | Усилие нагружения
        Szánkó tömege | Csúszka tömege | Normálerő | Kızak ağırlığı | Kızak kütlesi | Ölü ağırlık
        Hmotnost saní | Hmotnost závaží | Přítlačná síla | Přítlak | Masa sań | Masa obciążnika
        Masa del trineo | Peso del trineo | Massa do trenó | Masse du traîneau | Masse du patin
        Massa della slitta | Peso della slitta
    """,
    "stroke": """
        Stroke | Stroke length | Stroke distance | Track length | Stroke (peak to peak)
        | Reciprocating stroke | Sliding stroke
        行程 | 冲程 | 往复行程 | 行程长度 | 振幅行程
        Zdvih | Délka zdvihu
        Slaglængde | Vandring | Slag
        Slag | Slaglengte | Slagweg
        Iskunpituus | Isku
        Course | Longueur de course | Amplitude de course | Course totale
        Hub | Hublänge | Schwingweg | Hubweg
        Lökethossz | Löket
        Corsa | Lunghezza corsa | Lunghezza della corsa | Ampiezza corsa
        ストローク | 振幅 | ストローク長 | 往復距離 | 摺動距離
        스트로크 | 행정 | 왕복 거리
        Slaglengde | Slag
        Skok | Długość skoku
        Curso | Comprimento do curso | Comprimento de curso
        Cursa | Lungimea cursei
        Ход | Длина хода | Амплитуда хода
        Zdvih | Dĺžka zdvihu
        Carrera | Longitud de carrera | Recorrido
        Slaglängd | Slag
        Strok | Strok uzunluğu | Kurs
        Хід | Довжина ходу
    """,
    "frequency": """
        Frequency | Stroke frequency | Reciprocating frequency | Oscillation frequency
        | Cycle frequency | Reciprocation frequency
        频率 | 往复频率 | 运动频率 | 振动频率
        Frekvence | Frekvence pohybu | Kmitočet
        Frekvens
        Frequentie | Slagfrequentie | Bewegingsfrequentie
        Taajuus | Iskutaajuus
        Fréquence | Fréquence de mouvement | Fréquence d'oscillation
        Frequenz | Hubfrequenz | Schwingfrequenz
        Frekvencia | Löketfrekvencia
        Frequenza | Frequenza di oscillazione | Frequenza di moto
        周波数 | 往復周波数 | 振動数 | 往復回数
        주파수 | 왕복 주파수
        Frekvens
        Częstotliwość | Częstotliwość ruchu | Częstotliwość oscylacji
        Frequência | Frequência de oscilação | Frequência do movimento
        Frecvența | Frecvenţa
        Частота | Частота хода | Частота колебаний | Частота движения
        Frekvencia
        Frecuencia | Frecuencia de oscilación | Frecuencia de movimiento
        Frekvens | Slagfrekvens | Rörelsefrekvens
        Frekans | Hareket frekansı
        Частота | Частота руху
    """,
    "track_radius": """
        Track radius | Wear track radius | Radius of wear track | Sliding radius | Radius of track
        | Wear radius | Mean contact radius | Effective radius | Mean radius | Friction radius
        摩擦半径 | 回转半径 | 磨痕半径 | 轨迹半径 | 旋转半径
        Poloměr dráhy | Poloměr stopy
        Sporradius | Baneradius
        Loopspoorstraal | Spoorstraal | Baanstraal | Straal van het spoor
        Radan säde | Kulumisuran säde | Uran säde | Kitkasäde | Kitkaradan säde | Liukusäde
        Friktionsradius | Friksjonsradius | Friktionsradie | Glideradius | Gleitradius
        Wrijvingsstraal | Rayon de glissement | Raggio di attrito | Raggio medio | Rayon moyen
        Radio de fricción
        Raio de atrito | Poloměr tření | Promień ślizgu | Súrlódási sugár | Sürtünme yarıçapı
        Средний радиус
        Rayon de piste | Rayon de la piste | Rayon de frottement | Rayon de trace
        Reibradius | Spurradius | Laufradius | Bahnradius | Laufbahnradius
        Pálya sugara | Kopásnyom sugara | Pályasugár
        Raggio pista | Raggio della pista | Raggio traccia | Raggio di strisciamento
        摺動半径 | 回転半径 | 摩擦半径 | 軌道半径
        트랙 반경 | 마찰 반경 | 회전 반경 | 반지름
        Sporradius | Baneradius
        Promień toru | Promień tarcia | Promień ścieżki
        Raio da pista | Raio de pista | Raio da trilha
        Raza pistei | Raza urmei
        Радиус дорожки | Радиус дорожки трения | Радиус трения
        Polomer dráhy | Polomer stopy
        Radio de pista | Radio de la pista | Radio de giro | Radio de la huella
        Spårradie | Spårets radie | Banradie
        İz yarıçapı | Aşınma izi yarıçapı | Yarıçap
        Радіус доріжки
    """,
    "track_diameter": """
        Track diameter | Track dia | Wear track diameter | Mean track diameter | Wear track dia.
        磨痕直径 | 轨迹直径 | 摩擦直径
        Průměr dráhy | Průměr stopy
        Spordiameter | Banediameter
        Spoordiameter | Loopspoordiameter | Baandiameter
        Radan halkaisija | Uran halkaisija
        Diamètre de piste | Diamètre de la piste | Diamètre de frottement
        Spurdurchmesser | Reibdurchmesser | Laufbahndurchmesser
        Pálya átmérője | Pályaátmérő
        Diametro pista | Diametro della traccia | Diametro della pista
        摺動直径 | 摩擦直径 | 軌道直径 | 摺動径
        트랙 직경 | 마찰 직경 | 트랙 지름
        Spordiameter
        Średnica toru | Średnica ścieżki | Średnica tarcia
        Diâmetro da pista | Diâmetro de pista | Diâmetro da trilha
        Diametrul pistei
        Диаметр дорожки | Диаметр дорожки трения
        Priemer dráhy | Priemer stopy
        Diámetro de pista | Diámetro de la pista | Diámetro de la huella
        Spårdiameter | Bandiameter
        İz çapı | Aşınma izi çapı
        Діаметр доріжки
    """,
    "sampling_rate": """
        Sampling rate | Sample rate | Sampling frequency | Acquisition rate | Data rate
        | Logging rate | Scan rate | Acquisition frequency
        采样频率 | 采样率 | 采集频率 | 取样频率
        Vzorkovací frekvence | Frekvence vzorkování | Rychlost vzorkování
        Samplingsfrekvens | Samplingsrate | Målefrekvens
        Bemonsteringsfrequentie | Meetfrequentie | Bemonsteringssnelheid | Samplefrequentie
        Näytteenottotaajuus | Mittaustaajuus | Näytetaajuus
        Fréquence d'échantillonnage | Fréquence d'acquisition | Cadence d'acquisition
        | Taux d'échantillonnage
        Abtastrate | Abtastfrequenz | Messrate | Messfrequenz
        Mintavételi frekvencia | Mintavételezési frekvencia
        Frequenza di campionamento | Velocità di campionamento | Frequenza di acquisizione
        サンプリング周波数 | サンプリングレート | 測定周波数 | サンプリング速度
        샘플링 주파수 | 샘플링 속도 | 샘플링 레이트
        Samplingsfrekvens | Samplingsrate | Målefrekvens
        Częstotliwość próbkowania | Szybkość próbkowania
        Frequência de amostragem | Taxa de amostragem | Frequência de aquisição
        | Taxa de aquisição
        Frecvența de eșantionare | Rata de eșantionare
        Частота дискретизации | Частота опроса | Частота выборки
        Vzorkovacia frekvencia
        Frecuencia de muestreo | Tasa de muestreo | Frecuencia de adquisición
        | Velocidad de muestreo
        Samplingsfrekvens | Samplingshastighet | Mätfrekvens | Samplingstakt
        Örnekleme frekansı | Örnekleme hızı
        Частота дискретизації
    """,
    "pitch": """
        Pitch | Spacing | Point spacing | Sampling interval | Step size | Data spacing
        | Lateral sampling | X increment | Sample spacing | Point distance
        采样间隔 | 间距 | 步长 | 点间距 | 采样间距
        Krok | Rozteč bodů | Vzdálenost bodů | Krok vzorkování
        Punktafstand | Skridtlængde | Afstand mellem punkter | Trinlængde
        Stapgrootte | Puntafstand | Afstand tussen punten | Meetstap
        Askel | Pisteväli | Näyteväli | Askelpituus
        Pas | Pas d'échantillonnage | Pas de mesure | Distance entre points
        Punktabstand | Schrittweite | Messpunktabstand | Abtastintervall
        Lépésköz | Ponttávolság | Mintavételi távolság
        Passo | Passo di campionamento | Distanza tra i punti | Passo di misura
        測定ピッチ | サンプリング間隔 | データ間隔 | ピッチ | 測定間隔
        간격 | 측정 간격 | 샘플링 간격 | 피치
        Punktavstand | Steglengde | Avstand mellom punkter
        Krok | Krok próbkowania | Odległość między punktami | Odstęp punktów
        Passo | Passo de amostragem | Distância entre pontos | Espaçamento
        Pas | Pasul | Distanța dintre puncte
        Шаг | Шаг дискретизации | Шаг измерения | Расстояние между точками
        Krok | Vzdialenosť bodov
        Paso | Paso de muestreo | Distancia entre puntos | Intervalo de muestreo
        Steglängd | Punktavstånd | Mätsteg | Avstånd mellan punkter
        Adım | Örnekleme aralığı | Nokta aralığı
        Крок
    """,
    "profile_length": """
        Scan length | Traverse length | Trace length | Measurement length | Profile length
        | Assessment length | Measuring length | Tracing length | Data length
        测量长度 | 扫描长度 | 评定长度 | 取样长度
        Délka měření | Měřená délka | Celková délka
        Målelængde | Samlet længde
        Meetlengte | Tastlengte | Totale lengte
        Mittauspituus | Kokonaispituus
        Longueur de palpage | Longueur de mesure | Longueur totale | Longueur explorée
        Messstrecke | Taststrecke | Messlänge | Gesamtlänge
        Mérési hossz | Teljes hossz
        Lunghezza di misura | Lunghezza di esplorazione | Lunghezza totale
        | Lunghezza di traslazione
        測定長さ | 評価長さ | 走査長さ | 測定距離
        측정 길이 | 평가 길이 | 스캔 길이
        Målelengde | Total lengde
        Długość pomiaru | Długość odcinka | Długość profilu | Odcinek pomiarowy
        Comprimento de medição | Comprimento de varredura | Comprimento total
        | Comprimento de avaliação
        Lungimea de măsurare | Lungime totală
        Длина трассы | Длина измерения | Длина профиля
        Dĺžka merania | Meraná dĺžka
        Longitud de medición | Longitud de exploración | Longitud total | Longitud medida
        Mätlängd | Mätsträcka | Total längd
        Ölçüm uzunluğu | Toplam uzunluk | Tarama uzunluğu
        Довжина вимірювання | Довжина траси
    """,
    "points": """
        Number of points | Points | No. of points | Number of data points | Samples | Data points
        | Num points
        点数 | 数据点数 | 采样点数 | 测量点数
        Počet bodů | Počet vzorků | Počet hodnot
        Antal punkter | Antal målepunkter
        Aantal punten | Aantal meetpunten | Aantal waarden
        Pisteiden määrä | Pisteitä | Mittauspisteiden lukumäärä
        Nombre de points | Nb de points | Nombre de valeurs
        Anzahl Punkte | Punktanzahl | Anzahl der Messpunkte | Anzahl Werte
        Pontok száma | Mérési pontok száma
        Numero di punti | Numero punti | N. punti
        データ点数 | 測定点数 | 点数 | データ数
        점 개수 | 데이터 수 | 측정점 수 | 데이터 개수
        Antall punkter | Antall målepunkter
        Liczba punktów | Ilość punktów
        Número de pontos | N.º de pontos | Quantidade de pontos
        Număr de puncte | Numărul de puncte
        Количество точек | Число точек
        Počet bodov
        Número de puntos | Nº de puntos | Cantidad de puntos
        Antal punkter | Antal mätpunkter | Antal värden
        Nokta sayısı | Veri sayısı
        Кількість точок
    """,
    "step": """
        Step | Step no. | Step number | Stage | Segment | Phase
        步骤 | 阶段 | 工步 | 段号
        Krok | Stupeň | Fáze
        Trin
        Stap | Trap
        Vaihe | Askel | Porras
        Étape | Palier | Phase | Pas n°
        Stufe | Schritt | Abschnitt | Prüfstufe | Laststufe
        Lépés | Szakasz | Fokozat
        Fase | Passo | Gradino | Step
        ステップ | 段階
        단계 | 스텝
        Trinn | Steg
        Krok | Etap | Stopień
        Etapa | Passo | Degrau | Patamar
        Etapa | Treapta
        Шаг | Этап | Ступень
        Krok | Stupeň
        Etapa | Paso | Escalón | Fase
        Steg
        Adım | Kademe
        Крок | Етап
    """,
}
# fmt: on


def _terms(lines: str) -> tuple[str, ...]:
    return tuple(
        term for line in lines.splitlines() for word in line.split("|") if (term := word.strip())
    )


TERMS = {concept: _terms(lines) for concept, lines in _LINES.items()}
