"""Makes the bundled fonts from Inter: `python subset.py FOLDER_OF_INTER_OTF`, with fonttools.

Kept are the letters and signs that reports need; digits are those of equal width; outlines are
quadratic, which is what TrueType fonts in a PDF hold; tables of layout and hints are left out.
"""

import sys
from pathlib import Path

from fontTools import subset
from fontTools.pens.cu2quPen import Cu2QuPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont, newTable

# Latin, Greek, punctuation, superscripts, arrows, mathematics, shapes.
RANGES = [
    (0x20, 0x7E), (0xA0, 0x17F), (0x370, 0x3FF), (0x2010, 0x2027), (0x2030, 0x203A),
    (0x2070, 0x209F), (0x20AC, 0x20AC), (0x2190, 0x2199), (0x2200, 0x22FF), (0x25A0, 0x25FF),
    (0x2713, 0x2717), (0xFFFD, 0xFFFD),
]
# Largest deviation of a quadratic outline from the cubic one (units of 1/2816 of the size).
TOLERANCE = 0.8


def equal_digits(font):
    """Replaces the plain digits and signs by those of equal width."""
    substitutes = {}
    table = font["GSUB"].table
    for record in table.FeatureList.FeatureRecord:
        if record.FeatureTag == "tnum":
            for index in record.Feature.LookupListIndex:
                for part in table.LookupList.Lookup[index].SubTable:
                    part = getattr(part, "ExtSubTable", part)
                    substitutes.update(getattr(part, "mapping", {}))
    for cmap in font["cmap"].tables:
        if cmap.isUnicode():
            for code in [*range(0x30, 0x3A), 0x2B, 0x2212]:
                cmap.cmap[code] = substitutes.get(cmap.cmap.get(code), cmap.cmap.get(code))
            # The font has no dot operator; a middle dot looks the same.
            cmap.cmap.setdefault(0x22C5, cmap.cmap[0xB7])


def to_truetype(font):
    """Turns cubic outlines into quadratic ones."""
    glyphs, order = font.getGlyphSet(), font.getGlyphOrder()
    outlines = {}
    for name in order:
        pen = TTGlyphPen(None)
        glyphs[name].draw(Cu2QuPen(pen, TOLERANCE, reverse_direction=True))
        outlines[name] = pen.glyph()
    for table in ("CFF ", "VORG"):
        if table in font:
            del font[table]
    font["loca"] = newTable("loca")
    font["glyf"] = newTable("glyf")
    font["glyf"].glyphOrder, font["glyf"].glyphs = order, outlines
    limits = font["maxp"]
    limits.tableVersion = 0x00010000
    limits.maxZones = 1
    for name in (
        "maxTwilightPoints maxStorage maxFunctionDefs maxInstructionDefs maxStackElements "
        "maxSizeOfInstructions maxComponentElements maxPoints maxContours maxCompositePoints "
        "maxCompositeContours maxComponentDepth"
    ).split():
        setattr(limits, name, 0)
    font["post"].formatType = 3.0
    font["head"].glyphDataFormat = 0
    font.sfntVersion = "\0\1\0\0"


def main(folder):
    for weight in ("Regular", "SemiBold"):
        font = TTFont(Path(folder) / f"Inter-{weight}.otf")
        equal_digits(font)
        options = subset.Options()
        options.layout_features = []
        options.hinting = False
        options.desubroutinize = True
        options.notdef_outline = True
        options.name_IDs = [0, 1, 2, 3, 4, 5, 6, 7, 13, 14]
        options.drop_tables += ["GPOS", "GSUB", "GDEF", "DSIG", "STAT", "meta", "BASE"]
        subsetter = subset.Subsetter(options)
        subsetter.populate(unicodes=[c for a, b in RANGES for c in range(a, b + 1)])
        subsetter.subset(font)
        to_truetype(font)
        font["head"].modified = font["head"].created
        font.recalcTimestamp = False
        font.save(Path(__file__).parent / f"Inter-{weight}.ttf")


if __name__ == "__main__":
    main(*sys.argv[1:])
