PEERS = {}


def compare(report, rounds):
    pass
