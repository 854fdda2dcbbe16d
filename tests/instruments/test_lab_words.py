"""Files of laboratories of two dozen languages, in whose own terms everything is said."""

from __future__ import annotations

import numpy as np
import pytest

import tribolab as tl
from tribolab.reading.interpret.names import matches
from tribolab.reading.lexicon.lexicon import known_words
from tribolab.reading.unknown.layout.lines import find_encoding

TERMS = {
    word.quantity: [term for terms in word.terms.values() for term in terms]
    for word in known_words()
}
LANGUAGES = {
    "Czech": ("Třecí síla", "Zatížení", "Čas", "Zdvih", "Frekvence", "Otáčky", "Poloměr dráhy"),
    "Danish": ("Friktionskraft", "Belastning", "Tid", "Slaglængde", "Frekvens", "Omdrejningstal")
    + ("Sporradius",),
    "Dutch": ("Wrijvingskracht", "Belasting", "Tijd", "Slaglengte", "Frequentie", "Toerental")
    + ("Spoorstraal",),
    "Finnish": ("Kitkavoima", "Kuorma", "Aika", "Iskunpituus", "Taajuus", "Pyörimisnopeus")
    + ("Radan säde",),
    "French": ("Force de frottement", "Charge appliquée", "Temps", "Longueur de course")
    + ("Fréquence", "Tours par minute", "Rayon de piste"),
    "German": ("Reibkraft", "Prüfkraft", "Prüfzeit", "Hubweg", "Hubfrequenz", "Drehzahl")
    + ("Reibradius",),
    "Hungarian": ("Súrlódási erő", "Terhelés", "Idő", "Lökethossz", "Frekvencia", "Fordulatszám")
    + ("Pályasugár",),
    "Italian": ("Forza di attrito", "Carico", "Tempo", "Corsa", "Frequenza", "Numero di giri")
    + ("Raggio pista",),
    "Japanese": ("摩擦力", "設定荷重", "経過時間", "ストローク", "周波数", "回転数", "摺動半径"),
    "Korean": ("마찰력", "시험 하중", "시간", "스트로크", "주파수", "회전수", "트랙 반경"),
    "Norwegian": ("Friksjonskraft", "Belastning", "Tid", "Slaglengde", "Frekvens", "Turtall")
    + ("Sporradius",),
    "Polish": ("Siła tarcia", "Obciążenie", "Czas", "Skok", "Częstotliwość", "Obroty")
    + ("Promień toru",),
    "Portuguese": ("Força de atrito", "Carga aplicada", "Tempo", "Curso", "Frequência", "Rotação")
    + ("Raio da pista",),
    "Romanian": ("Forța de frecare", "Sarcina", "Timp", "Cursa", "Frecvența", "Turația")
    + ("Raza pistei",),
    "Russian": ("Сила трения", "Нагрузка", "Время", "Длина хода", "Частота", "Частота вращения")
    + ("Радиус дорожки",),
    "Slovak": ("Trecia sila", "Zaťaženie", "Čas", "Dĺžka zdvihu", "Frekvencia", "Otáčky")
    + ("Polomer stopy",),
    "Spanish": ("Fuerza de rozamiento", "Carga", "Tiempo", "Carrera", "Frecuencia")
    + ("Revoluciones por minuto", "Radio de la huella"),
    "Swedish": ("Friktionskraft", "Normallast", "Provtid", "Slaglängd", "Frekvens", "Varvtal")
    + ("Spårradie",),
    "Turkish": ("Sürtünme kuvveti", "Uygulanan yük", "Süre", "Strok", "Frekans", "Devir")
    + ("İz yarıçapı",),
    "Ukrainian": ("Сила тертя", "Навантаження", "Час", "Довжина ходу", "Частота", "Оберти")
    + ("Радіус доріжки",),
    "Chinese": ("摩擦力", "试验载荷", "测试时间", "往复行程", "往复频率", "转速", "磨痕半径"),
}


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_disc_is_understood_in_the_terms_of_a_language(language, tmp_path):
    friction, load, time, _, _, turns, radius = LANGUAGES[language]
    rng = np.random.default_rng(1)
    rows = [
        f"{0.1 * n:.1f};{60 if n < 300 else 120};{6 + 0.1 * rng.standard_normal():.3f}"
        for n in range(600)
    ]
    head = f"{load}: 20 N\n{radius}: 15 mm\n\n{time} [s];{turns} [1/min];{friction} [N]\n"
    (tmp_path / "disc.csv").write_text(head + "\n".join(rows) + "\n", "utf-8")
    run = tl.read(tmp_path / "disc.csv")
    found = tl.friction_coefficient(run, tl.find_segments(run))
    speeds = [2 * np.pi * rpm / 60 * 0.015 for rpm in (60, 120)]
    np.testing.assert_allclose(found.sliding_speed, speeds, rtol=1e-6)
    np.testing.assert_allclose(found.friction_coefficient, 0.3, rtol=0.01)


@pytest.mark.parametrize("language", LANGUAGES)
def test_strokes_are_understood_in_the_terms_of_a_language(language, tmp_path):
    friction, load, time, stroke, frequency, _, _ = LANGUAGES[language]
    t = np.arange(4000) / 200
    force = 4 * np.sign(np.sin(2 * np.pi * t)) + 0.05 * np.random.default_rng(2).normal(size=4000)
    rows = (f"{a:.3f}\t{f:.3f}" for a, f in zip(t, force, strict=True))
    head = f"{stroke} = 10 mm\n{frequency} = 1 Hz\n{load} = 8 N\nDrive: crank\n\n"
    head += f"{time} [s]\t{friction} [N]\n"
    (tmp_path / "strokes.txt").write_text(head + "\n".join(rows) + "\n", "utf-8")
    run = tl.read(tmp_path / "strokes.txt")
    assert (run.attrs["stroke_m"], run.attrs["stroke_frequency_Hz"]) == pytest.approx(
        (0.01, 1.0), rel=0.01
    )
    found = tl.friction_coefficient(run, tl.find_segments(run))
    assert float(found.friction_coefficient.mean()) == pytest.approx(0.5, rel=0.01)


ENCODINGS = {
    "Czech": ("cp1250", "iso8859-2", "cp852"),
    "Finnish": ("latin-1", "cp437", "mac-roman"),
    "German": ("cp1252", "cp437", "mac-roman"),
    "Hungarian": ("cp1250", "iso8859-2"),
    "Japanese": ("cp932",),
    "Korean": ("cp949",),
    "Polish": ("cp1250", "iso8859-2", "cp852"),
    "Russian": ("cp1251", "koi8-r", "cp866"),
    "Slovak": ("cp1250",),
    "Swedish": ("latin-1", "cp437"),
    "Turkish": ("cp1254",),
    "Ukrainian": ("cp1251",),
    "Chinese": ("gb18030",),
}


@pytest.mark.parametrize(
    ("language", "encoding"), [(key, name) for key, names in ENCODINGS.items() for name in names]
)
def test_terms_tell_in_which_encoding_they_are_written(language, encoding, tmp_path):
    friction, load, time, stroke, _, turns, radius = LANGUAGES[language]
    force = "Höhe;" if language == "German" else ""
    lines = [
        f"{load};20;N",
        f"{radius};15;mm",
        f"{stroke};3;mm",
        f"{time};{force}{friction};{turns}",
    ]
    content = "\n".join([*lines, *("1;2;3" for _ in range(40))]).encode(encoding)
    found = find_encoding(content)[0]
    assert content.decode(found) == content.decode(encoding)


def test_every_term_of_a_column_is_known_and_none_means_two_forces():
    for name in ("friction_force", "normal_force"):
        for term in TERMS[name]:
            options = matches(term, "N")
            assert options[0].quantity == name and options[0].score > 0.85, term
