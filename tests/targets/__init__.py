from pathlib import Path

APPENDIX_D = Path(__file__).parents[1] / "data" / "appendix_d_correlation.csv"
