/* The style of a page. A ray's numbers are visible while its line is pointed at, focused or the address's fragment. */
#pragma once

#define PAGE_STYLE                                                                                            \
    ":root{color-scheme:light dark;--paper:#ffffff;--ink:#1c1c1c;--soft:#f1f1f1;--edge:#c4c4c4;"              \
    "--link:#0b57a4;--mark:#fff0b8}\n"                                                                        \
    "@media (prefers-color-scheme:dark){:root{--paper:#16181c;--ink:#e8e8e8;--soft:#23262c;--edge:#4a4e57;"   \
    "--link:#8ab8f0;--mark:#4d4213}}\n"                                                                       \
    "body{margin:0 auto;max-width:70rem;padding:1rem;background:var(--paper);color:var(--ink);"               \
    "font:1rem/1.45 system-ui,sans-serif}\n"                                                                  \
    "h1{font-size:1.4rem;margin:0 0 .75rem}h2{font-size:1.1rem;margin:1.5rem 0 .5rem}p{margin:.5rem 0}\n"     \
    "a{color:var(--link)}\n"                                                                                  \
    ".stage{position:relative;margin:0 auto;background:var(--soft)}\n"                                        \
    ".stage img{position:absolute;top:0;left:0;width:100%;height:auto}\n"                                     \
    ".stage svg{position:relative;display:block;width:100%;height:auto;fill:none;stroke-linecap:round}\n"     \
    "svg text{fill:var(--ink)}svg rect{fill:var(--soft)}\n"                                                   \
    ".numbers{visibility:hidden;pointer-events:none}svg a{outline:none}\n"                                    \
    "svg a:hover .numbers,svg a:focus .numbers,svg a:target .numbers{visibility:visible}\n"                   \
    "svg a:hover .halo,svg a:focus .halo,svg a:target .halo{stroke:#ffe14d;stroke-opacity:1}\n"               \
    ".halo{stroke:#000000;stroke-opacity:.55}.near{stroke:#000000;stroke-opacity:0}\n"                        \
    ".camera{stroke:#ffffff}.reflect{stroke:#ff8f4d}.refract{stroke:#5cb8ff}\n"                               \
    ".shadow{stroke:#ffc93c;stroke-dasharray:5 3}.blocked{stroke:#b4b4b4;stroke-dasharray:5 3}\n"             \
    ".frame{overflow:auto;max-height:26rem;border:1px solid var(--edge)}\n"                                   \
    "table{border-collapse:collapse;font-size:.85rem;font-variant-numeric:tabular-nums;white-space:nowrap}\n" \
    "th,td{padding:.2rem .5rem;text-align:left;border-bottom:1px solid var(--edge)}\n"                        \
    "thead th{position:sticky;top:0;background:var(--soft)}tr:target{background:var(--mark)}\n"               \
    "pre{overflow:auto;max-height:26rem;margin:0;padding:.6rem;background:var(--soft);font-size:.85rem}\n"    \
    "#turn{font:inherit;padding:.5rem 1rem}#turned{width:100vw;height:100dvh;max-width:none;max-height:none;" \
    "box-sizing:border-box;margin:0;padding:0;border:0;background:var(--paper)}\n"                            \
    "#turned[open]{display:flex;flex-direction:column}#turned form{padding:.25rem}\n"                         \
    "#turned iframe{flex:1;width:100%;border:0}\n"
