"""The report page: one self-contained HTML file made of sections."""

from __future__ import annotations

from doe_kc.report.page.correlation import correlation_sections, write_correlation_page
from doe_kc.report.page.discovery import discovery_sections, write_discovery_page
from doe_kc.report.render.page import Section, embedded, page_html, render, write_page

__all__ = [
    "Section",
    "correlation_sections",
    "discovery_sections",
    "embedded",
    "page_html",
    "render",
    "write_correlation_page",
    "write_discovery_page",
    "write_page",
]
