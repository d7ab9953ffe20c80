#include "report/frame.hpp"

#include "base/markup.hpp"
#include "report/plot.hpp"

namespace fathom::report {
namespace {

constexpr const char* kStyle = R"(
:root{--ground:#eef2f5;--card:#fff;--line:#c3ccd4;--ink:#13202b;--soft:#4a5a67;--accent:#00507a;--good:#0b6b3a;
--good-ground:#ddf2e4;--caution:#7a4a00;--caution-ground:#ffefcf;--bad:#a3121f;--bad-ground:#fde1e2;--s1:#00629b;
--s2:#b34700;--s3:#00744d;--s4:#8a3a86;--s5:#665c00;--s6:#4a5a67;color-scheme:light dark}
@media screen and (prefers-color-scheme:dark){:root{--ground:#0a1016;--card:#121b23;--line:#2c3a46;--ink:#d9e3ea;
--soft:#9db0bd;--accent:#6cc0f0;--good:#6fdc9a;--good-ground:#0f2a1b;--caution:#ffc454;--caution-ground:#30240a;
--bad:#ff8d8d;--bad-ground:#3a1216;--s1:#6cc0f0;--s2:#ffa25c;--s3:#5fd6a4;--s4:#d99ad6;--s5:#d9cc5a;--s6:#9db0bd}}
*{box-sizing:border-box}body{margin:0;background:var(--ground);color:var(--ink);font:15px/1.45 system-ui,sans-serif}
main{max-width:940px;margin:0 auto;padding:16px}h1{font-size:22px;margin:8px 0 2px}h2{font-size:17px;margin:0 0 8px}
p{margin:6px 0}.soft{color:var(--soft)}section{background:var(--card);border:1px solid var(--line);border-radius:6px;
padding:14px;margin:14px 0}svg{max-width:100%;height:auto;display:block;margin:6px 0}a{color:var(--accent)}
ul.findings{list-style:none;margin:0;padding:0}ul.findings li{padding:7px 10px;border-radius:4px;margin:6px 0}
li.bad{background:var(--bad-ground)}li.caution{background:var(--caution-ground)}li.good{background:var(--good-ground)}
li b{display:inline-block;min-width:84px}li.bad b{color:var(--bad)}li.caution b{color:var(--caution)}
li.good b{color:var(--good)}table{border-collapse:collapse;font-size:13px;margin:8px 0;display:block;overflow-x:auto}
th,td{border-bottom:1px solid var(--line);padding:3px 9px;text-align:right;white-space:nowrap}
th:first-child,td:first-child,td.words{text-align:left}td.words,th{white-space:normal}th{color:var(--soft);font-weight:600}
.tiles{display:flex;flex-wrap:wrap;gap:10px;margin:10px 0}.tiles div{background:var(--card);border:1px solid var(--line);
border-radius:6px;padding:8px 12px;min-width:130px}.tiles strong{display:block;font-size:18px}
@media print{body{background:#fff;font-size:11pt}main{max-width:none;padding:0}section{border:0;padding:0;
break-inside:auto}svg,ul.findings li,table{break-inside:avoid}li{border:1px solid var(--line)}nav{display:none}}
)";

}  // namespace

std::string page_begin(const std::string& title) {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"><title>" +
         escaped(title) + "</title><style>" + kStyle + plot_style() + "</style></head>\n<body><main>\n<h1>" +
         escaped(title) + "</h1>\n";
}

std::string page_end() {
  return "</main></body></html>\n";
}

std::string section(const std::string& id, const std::string& title, const std::string& content) {
  return "<section id=\"" + id + "\"><h2>" + title + "</h2>\n" + content + "</section>\n";
}

}  // namespace fathom::report
