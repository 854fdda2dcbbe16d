"""What files that hold names and values call a unit, a name and a value, in several languages."""

from __future__ import annotations

UNIT_KEYS = (
    *("unit", "units", "unit_string", "uom", "einheit", "einheiten", "eenheid", "unité", "unite"),
    *("unités", "unidad", "unidades", "unidade", "unità", "unita", "enhet", "enhed", "yksikkö"),
    *("jednotka", "jednotky", "jednostka", "mértékegység", "birim", "единица", "единицы", "ед"),
    *("单位", "單位", "単位", "단위"),
)
NAME_KEYS = (
    *("name", "label", "title", "channel", "id", "key", "quantity", "signal", "bezeichnung"),
    *("kanal", "größe", "naam", "nom", "nombre", "nome", "namn", "navn", "nimi", "název", "nazwa"),
    *("név", "ad", "имя", "название", "名称", "名前", "이름"),
)
VALUE_KEYS = (
    *("value", "val", "wert", "magnitude", "waarde", "valeur", "valor", "valore", "värde"),
    *("verdi", "værdi", "arvo", "hodnota", "wartość", "érték", "değer", "значение", "值", "数值"),
    *("値", "값"),
)
