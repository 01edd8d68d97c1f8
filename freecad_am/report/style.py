# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the page looks, light and dark."""

STYLE = """
:root{--ink:#1d2430;--soft:#667085;--line:#dfe3ea;--paper:#fff;--ground:#f3f5f8;--good:#1a7f4b;--bad:#b8322a;--warn:#9a6700}
@media(prefers-color-scheme:dark){:root{--ink:#e6e9ef;--soft:#98a2b3;--line:#323a47;--paper:#1a202b;--ground:#11151c;
--good:#4cc38a;--bad:#ff7a70;--warn:#e2b340}}
*{box-sizing:border-box}body{margin:0;background:var(--ground);color:var(--ink);font:15px/1.5 system-ui,sans-serif}
main{max-width:1040px;margin:0 auto;padding:28px 20px 60px}h1{font-size:28px;margin:0}h2{font-size:18px;margin:34px 0 10px}
header{display:flex;align-items:center;gap:14px;flex-wrap:wrap}.sub{color:var(--soft);margin:4px 0 18px}
.status{font-weight:600;padding:2px 12px;border-radius:99px;color:#fff;background:var(--good)}
.status.infeasible,.status.failed{background:var(--bad)}@media(prefers-color-scheme:dark){.status{color:#11151c}}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(125px,1fr));gap:10px;margin:0 0 16px}
.card,figure,.table{background:var(--paper);border:1px solid var(--line);border-radius:10px}
.card{padding:10px 12px}.card b{display:block;font-size:17px;white-space:nowrap;font-weight:600}
.card span{color:var(--soft);font-size:13px}
figure{margin:0;padding:8px}.grid{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(400px,100%),1fr));gap:10px}
figcaption{color:var(--soft);font-size:13px;padding:2px 8px 4px}
.table{overflow-x:auto}.findings{max-height:340px;overflow-y:auto}
table{border-collapse:collapse;width:100%;font-size:14px;font-variant-numeric:tabular-nums}
th,td{padding:6px 12px;text-align:right;border-top:1px solid var(--line);white-space:nowrap}
tr:first-child>*{border-top:0}th{color:var(--soft);font-weight:500}th:first-child,td:first-child{text-align:left}
td.text,td.place{text-align:left}td.text{white-space:normal}
.good{color:var(--good);font-weight:600}.unknown{color:var(--soft);font-style:italic}
.error{color:var(--bad);font-weight:600}.warning{color:var(--warn);font-weight:600}
svg{width:100%;height:auto;display:block}svg text{fill:var(--soft);font:11px system-ui,sans-serif}
svg .title{fill:var(--ink);font-size:13px;font-weight:600}
svg .grid{stroke:var(--line)}
svg .frame{fill:none;stroke:var(--soft);opacity:.5}
svg.plot path{stroke-linejoin:round}figure.wide{margin-top:10px}
svg .curve{fill:none;stroke-linejoin:round}
svg .asked{stroke:var(--soft);stroke-dasharray:5 4}
svg .rule{fill:var(--bad)}
svg .near,svg .far{fill:none;stroke-width:2.1;stroke-linejoin:round}
svg .far{stroke-width:1.2;opacity:.6}svg .direction{stroke:var(--ink);stroke-width:1.1;opacity:.6}
svg .body{stroke-width:.6;stroke-linejoin:round}
svg .b0,svg .b1{fill:#9aa4b5;stroke:#9aa4b5}svg .b2{fill:#a8b1c0;stroke:#a8b1c0}svg .b3{fill:#b5bdca;stroke:#b5bdca}
svg .b4{fill:#c2c9d4;stroke:#c2c9d4}svg .b5{fill:#ced4dd;stroke:#ced4dd}svg .b6{fill:#d9dee5;stroke:#d9dee5}
svg .platform{fill:var(--line);stroke:var(--soft);stroke-width:.8}svg .platform-side{fill:var(--soft);opacity:.55}
"""
